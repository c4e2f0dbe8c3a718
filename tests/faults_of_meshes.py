"""Faults of what is read of meshes: STL as programs write it, colours, points, normals."""
from fault import Fault

STL, COLORS = "frontend/ply/stl_reader.cpp", "frontend/ply/ply_faces.cpp"


def of_mesh(name, file, old, new, cases, test="ply"):
    return Fault(name, file, old, new, test, cases)


FAULTS = [
    of_mesh("bytes of one order", STL, "return plain(reversed(count), true);",
            "return plain(reversed(count));", "StlDialects.OfBinary"),
    of_mesh("attributes that are no lengths", STL, "if (lengths.end == bytes.size() &&",
            "if (false && lengths.end == bytes.size() &&", "StlDialects.OfBinary"),
    of_mesh("lengths in files that end exactly", STL,
            "if (all && bytes.size() - lengths.end", "if (false && bytes.size() - lengths.end",
            "StlDialects.OfBinary"),
    of_mesh("triangles of any bytes", STL, "v == 0 || (std::abs(v) >= kLeast",
            "true || (std::abs(v) >= kLeast", "StlDialects.OfBinary"),
    of_mesh("text without control characters", STL,
            "is_control) || has_stl_vertex(bytes);", "is_control);", "StlDialects.OfText"),
    of_mesh("loops of no vertices", STL, "if (end < loop_ + 3)",
            "if (end < loop_ + 3 && end != loop_)", "Stl.WhatIsBroken*"),
    of_mesh("one line that is a name", STL,
            "keyword == Keyword::kFacet && content_begins()", "false",
            "Stl.LoopsAndSolids"),
    of_mesh("loops that come back", STL, "if (end > loop_ + 3 && is_first",
            "if (false && is_first", "Stl.LoopsAndSolids"),
    of_mesh("a second solid without its end", STL, "(ended_ && keyword == Keyword::kUnknown)",
            "ended_", "Stl.WhatIsOdd*"),
    of_mesh("words behind the end that are warned of", STL,
            "if (skipped_.empty() && !ended_)", "if (skipped_.empty())", "Stl.WhatIsOdd*"),
    of_mesh("corners at 0 and -0", STL, "c == 0 ? 0.f : c", "c", "Stl.FarAndNearZero"),
    of_mesh("colours of faces first", COLORS, '{"vertex", "face"}', '{"face", "vertex"}',
            "PlyColors.OfVerticesBefore*"),
    of_mesh("bytes with a sign", COLORS, "c += 256;", "c += 0;", "PlyColors.AreReadByTheirRange"),
    of_mesh("plural names of two elements", "frontend/ply/ply_reader.cpp",
            "if (std::ranges::find(header.elements, name, &PlyElement::name) != "
            "header.elements.end())", "if (false)", "PlyColors.OfVerticesBefore*"),
    of_mesh("polygons without area that are left out", "frontend/scene/scene_builder_mesh.cpp",
            "result == Result::kNoArea && i < indices.size()", "false", "PlyAlone.Triangles*"),
    of_mesh("normals at 0 and -0", "frontend/scene/mesh.cpp", "(c + 0.f)", "(c)",
            "SmoothNormals.OfVerticesWritten*", "scene"),
    of_mesh("neighbours in the same place", "frontend/scene/mesh.cpp",
            "if (square > 0 &&", "if (", "Points.AreAsLarge*", "scene"),
]
