# Adds discs, a fifth kind of primitive, to a copy of the project, and tests them there: one file
# and one line of the kernel (two with its #include), and what callers fill in. docs/shapes.md
# shows it.
# cmake -D ROOT=project -D SCRATCH=folder -D COMPILER=c++ -D LAUNCHER=... -D FLAGS=... -D
# GENERATOR=Ninja -D SIMD=ON -P fifth_kind.cmake
# It goes red where a kind needs more than these lines: what does not compile, is not hit by every
# way of tracing, or hits itself.
cmake_minimum_required(VERSION 3.23)
function(run what)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE out ERROR_VARIABLE out)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${what} ended with ${status}:\n${out}")
  endif()
  message(STATUS "${what}: done")
endfunction()

file(REMOVE_RECURSE ${SCRATCH})
file(COPY ${ROOT}/include ${ROOT}/kernel DESTINATION ${SCRATCH})
file(COPY ${ROOT}/tests/support DESTINATION ${SCRATCH}/tests)

# Puts lines before the one place where `anchor` stands in a file.
function(add_before name anchor lines)
  file(READ ${SCRATCH}/${name} text)
  string(FIND "${text}" "${anchor}" first)
  string(FIND "${text}" "${anchor}" last REVERSE)
  if(first EQUAL -1 OR NOT first EQUAL last)
    message(FATAL_ERROR "${name}: expected one \"${anchor}\"")
  endif()
  string(REPLACE "${anchor}" "${lines}${anchor}" text "${text}")
  file(WRITE ${SCRATCH}/${name} "${text}")
endfunction()

# The kernel: the file, and the line of the list.
set(here ${ROOT}/tests/fifth_kind)
file(COPY ${here}/disc.hpp DESTINATION ${SCRATCH}/kernel/shapes)
add_before(kernel/shapes/shapes.hpp "#include \"kernel/shapes/plane.hpp\""
  "#include \"kernel/shapes/disc.hpp\"\n")
add_before(kernel/shapes/shapes.hpp ">;\n/// How many; PrimitiveKind" ", Disc")

# What callers fill in: a name, arrays, and views of them.
add_before(include/grelha/geometry.hpp " };\n\n/// A primitive, named by its kind" ", kDisc")
add_before(include/grelha/geometry.hpp "/// Indexed triangles of all meshes"
"/// Discs of a plane around a point; the normal need not have unit length.
struct Discs {
  std::vector<float> x, y, z, nx, ny, nz, radius;
  std::vector<std::uint32_t> material;
  std::size_t size() const { return material.size(); }
  void add(Float3 p, Float3 n, float r, std::uint32_t m) {
    x.push_back(p.x);
    y.push_back(p.y);
    z.push_back(p.z);
    nx.push_back(n.x);
    ny.push_back(n.y);
    nz.push_back(n.z);
    radius.push_back(r);
    material.push_back(m);
  }
};

")
add_before(include/grelha/geometry.hpp "  Planes planes;\n" "  Discs discs;\n")
add_before(include/grelha/scene_spans.hpp "/// See Triangles."
"/// See Discs.
struct DiscSpans {
  Floats x, y, z, nx, ny, nz, radius;
  Indices material;
  DiscSpans() = default;
  DiscSpans(const Discs& d)
      : x(d.x), y(d.y), z(d.z), nx(d.nx), ny(d.ny), nz(d.nz), radius(d.radius),
        material(d.material) {}
  std::size_t size() const { return material.size(); }
};

")
add_before(include/grelha/scene_spans.hpp "  PlaneSpans planes;\n" "  DiscSpans discs;\n")
add_before(include/grelha/scene_spans.hpp "        planes(g.planes)," "        discs(g.discs),\n")

file(COPY ${here}/CMakeLists.txt ${here}/disc_test.cpp DESTINATION ${SCRATCH})
run("configuring" ${CMAKE_COMMAND} -S ${SCRATCH} -B ${SCRATCH}/build -G ${GENERATOR}
  -D CMAKE_BUILD_TYPE= -D CMAKE_CXX_COMPILER=${COMPILER}
  -D CMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER} "-DCMAKE_CXX_FLAGS=${FLAGS}"
  -D GRELHA_SIMD=${SIMD} -D GRELHA_ISAS=all -D GRELHA_UNITY=ON)
run("building the kernel with discs" ${CMAKE_COMMAND} --build ${SCRATCH}/build --target disc_test)
run("its test" ${SCRATCH}/build/disc_test)
