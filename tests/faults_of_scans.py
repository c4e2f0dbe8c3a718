"""Faults of pictures of scans: views, colours, turntables, points, STL, checks of meshes."""
from fault import Fault

VIEW, STL = "frontend/input/view.cpp", "frontend/ply/stl_reader.cpp"
FAULTS = [
    Fault("lights that stay", VIEW,
          "if (view.made_up_lights && options.lights_follow.value_or(true))", "if (false)",
          "default_view", "MadeUpLights.*"),
    Fault("views without the zoom", VIEW, "camera.orthographic_height /= by.zoom;", "",
          "default_view", "Orbit.Zoom*"),
    Fault("a turntable that stands", "frontend/cli/render_scene.cpp",
          "orbit.azimuth_deg += 360. * number", "orbit.azimuth_deg += 0. * number", "program",
          "Scans.ViewsOfATurntable*"),
    Fault("a sheet of one column", "frontend/cli/view_files.cpp",
          "std::size_t(number % columns)", "std::size_t(number % 1)", "program", "Scans.ASheet*"),
    Fault("bytes of colours that are light", "frontend/ply/ply_reader.cpp",
          "float(light_of_srgb(double(i) / 255))", "float(i) / 255", "ply_reader",
          "*PlyColors.AreLight*"),
    Fault("a glow without its colour", "kernel/shade/shade.hpp",
          "emission = emission * load3(h.color, i);", "", "shade", "Shade.ColorsAreMixed*"),
    Fault("corners that stay apart", STL, "k > 0 && place(order[k])", "false && place(order[k])",
          "ply_reader", "Stl.IsThePly*"),
    Fault("text that ends anywhere", STL, "if (mesh.x.size() != mesh.indices.size())", "if (false)",
          "ply_reader", "Stl.What*"),
    Fault("meshes that are always closed", "frontend/commands/mesh_report.cpp",
          "mesh.is_closed() ?", "true ?", "report", "*Mesh*"),
    Fault("grids of what moved", "kernel/grid/world.cpp",
          "first < end && begin < first + o.triangle_count)", "false)", "world", "Update.*"),
    Fault("insides that never stop", "kernel/query/inside.cpp",
          "each_run(points.size(), options, work, kPoints);\n}\n\ndouble",
          "work(0, points.size());\n}\n\ndouble", "exact", "Contains.Reports*"),
]
