# One picture by every instruction set that runs here, at two packet widths: its bytes must be those
# of hashes.txt, on every machine and from every compiler.
#   cmake -D PROGRAM=grelha -D NAME=balls -D ROOT=... -D SCRATCH=... [-D WRITE=ON] -P hashes.cmake
#   cmake -D PROGRAM=grelha -D ISA=avx512 ... -P hashes.cmake: whether that instruction set is there
# With WRITE it prints the line that hashes.txt should hold: for changes that are meant to change
# pictures.
cmake_minimum_required(VERSION 3.20)

# name | scene: a file of scenes/data, or a generator and its size | options
set(pictures
  "balls | balls 3 | --depth 8"
  "mount | mount 5 | --samples 4"
  "gears | gears 2 | --depth 8"
  "rings | rings 3 | --shadows area:1,4"
  "tetra | tetra 4 | --aa jitter:3"
  "tree | tree 5 | --aa adaptive:0.2,2"
  "lattice | lattice | --density 2"
  "distant | distant 3 | --lens 8,7,8"
  "knot | knot 3 | --glossy 0.1,4"
  "boat | boat | --error 0.02"
  "awning | awning | --sampler random --samples 8"
  "star | star | --accel none"
  "glass | glass.nff | --samples 4"
  "columns | columns.nff | --lens 4,10,4 --shadows random:1"
  "torus | torus.nff | --glossy 0.2,2 --samples 4")

file(MAKE_DIRECTORY "${SCRATCH}")
if(ISA)
  execute_process(COMMAND ${PROGRAM} render "${ROOT}/scenes/data/glass.nff" --quiet --size 1x1
    --isa ${ISA} -o "${SCRATCH}/${ISA}.pfm" RESULT_VARIABLE status ERROR_VARIABLE words)
  if(NOT status EQUAL 0)
    if(NOT words MATCHES "this (build|processor) has no ${ISA}")
      message(FATAL_ERROR "${words}")
    endif()
    message("SKIPPED: no picture is compared by ${ISA}: ${CMAKE_MATCH_0}")
  endif()
  return()
endif()

set(found FALSE)
foreach(line IN LISTS pictures)
  string(REGEX MATCH "^([a-z]+) \\| ([^|]*) \\| (.*)$" ignored "${line}")
  if(CMAKE_MATCH_1 STREQUAL NAME)
    set(scene "${CMAKE_MATCH_2}")
    separate_arguments(options UNIX_COMMAND "${CMAKE_MATCH_3}")
    set(found TRUE)
  endif()
endforeach()
if(NOT found)
  message(FATAL_ERROR "no picture ${NAME}")
endif()

if(scene MATCHES "\\.nff$")
  set(file "${ROOT}/scenes/data/${scene}")
else()
  separate_arguments(words UNIX_COMMAND "${scene}")
  list(POP_FRONT words generator)
  set(size)
  if(words)
    set(size --size ${words})
  endif()
  set(file "${SCRATCH}/${NAME}.nff")
  execute_process(COMMAND ${PROGRAM} scene ${generator} ${size} -o "${file}"
    RESULT_VARIABLE status OUTPUT_QUIET ERROR_QUIET)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "cannot write the scene ${scene}")
  endif()
endif()
file(SHA256 "${file}" scene_hash)

set(picture_hash)
set(instruction_sets)
foreach(isa scalar sse2 avx2 avx512 neon)
  foreach(packet 1 64 256)
    set(image "${SCRATCH}/${NAME}-${isa}-${packet}.pfm")
    execute_process(COMMAND ${PROGRAM} render "${file}" --quiet --size 96x72 --packet ${packet}
      --isa ${isa} ${options} -o "${image}"
      RESULT_VARIABLE status ERROR_VARIABLE words)
    if(NOT status EQUAL 0)
      if(words MATCHES "this (build|processor) has no ${isa}")
        break()
      endif()
      message(FATAL_ERROR "${NAME} by ${isa}: ${words}")
    endif()
    file(SHA256 "${image}" hash)
    file(REMOVE "${image}")
    list(APPEND instruction_sets ${isa})
    if(NOT picture_hash)
      set(picture_hash ${hash})
    elseif(NOT hash STREQUAL picture_hash)
      message(FATAL_ERROR
        "${NAME}: ${isa} with packets of ${packet} makes ${hash}, others before it ${picture_hash}")
    endif()
  endforeach()
endforeach()
list(REMOVE_DUPLICATES instruction_sets)

if(WRITE)
  message("${NAME} ${scene_hash} ${picture_hash}")
  return()
endif()
file(STRINGS "${CMAKE_CURRENT_LIST_DIR}/hashes.txt" wanted REGEX "^${NAME} ")
if(NOT wanted MATCHES "^${NAME} ([0-9a-f]+) ([0-9a-f]+)$")
  message(FATAL_ERROR "hashes.txt has no line for ${NAME}")
elseif(NOT scene_hash STREQUAL CMAKE_MATCH_1)
  message("SKIPPED: this system's sine and cosine make another scene")
elseif(NOT picture_hash STREQUAL CMAKE_MATCH_2)
  message(FATAL_ERROR "${NAME}: the picture is ${picture_hash}, should be ${CMAKE_MATCH_2}")
else()
  message("${NAME}: ${picture_hash} by ${instruction_sets}")
endif()
