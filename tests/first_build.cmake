# Configures for this processor alone: its best copy of the kernel, no tests,
# nothing that could be installed.
# cmake -D ROOT=project -D SCRATCH=folder -D COMPILER=c++ -D GENERATOR=Ninja -P first_build.cmake
file(REMOVE_RECURSE ${SCRATCH})
set(configure ${CMAKE_COMMAND} -S ${ROOT} -B ${SCRATCH} -G ${GENERATOR}
  -D CMAKE_CXX_COMPILER=${COMPILER}
  -D CMAKE_BUILD_TYPE=Release -D CMAKE_EXPORT_COMPILE_COMMANDS=ON)
execute_process(COMMAND ${configure} -D GRELHA_ISAS=native RESULT_VARIABLE status
  OUTPUT_VARIABLE said ERROR_VARIABLE said)
if(NOT status EQUAL 0)
  message(FATAL_ERROR "configuring ended with ${status}:\n${said}")
endif()
file(READ ${SCRATCH}/compile_commands.json commands)
string(REGEX MATCHALL "/variant_[a-z0-9]+\\.cpp\"" copies "${commands}")
list(REMOVE_DUPLICATES copies)
list(TRANSFORM copies REPLACE "/variant_(.*).cpp\"" "\\1")
if(NOT copies MATCHES "^(scalar|sse2|avx2|avx512|neon)$")
  message(FATAL_ERROR "copies: expected one, found ${copies}")
endif()
if(commands MATCHES "_test\\.cpp|/perf/")
  message(FATAL_ERROR "tests or benchmarks are built that want every copy")
endif()
execute_process(COMMAND ${CMAKE_COMMAND} --install ${SCRATCH} --prefix ${SCRATCH}/prefix
  RESULT_VARIABLE status OUTPUT_VARIABLE said ERROR_VARIABLE said)
if(status EQUAL 0 OR NOT said MATCHES "this build is for one processor")
  message(FATAL_ERROR "installing ended with ${status}:\n${said}")
endif()
execute_process(COMMAND ${configure} -D GRELHA_ISAS=avx2 RESULT_VARIABLE status OUTPUT_QUIET
  ERROR_VARIABLE said)
if(status EQUAL 0 OR NOT said MATCHES "GRELHA_ISAS: expected all or native, found \"avx2\"")
  message(FATAL_ERROR "a word that is none was taken:\n${said}")
endif()
