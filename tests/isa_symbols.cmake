# Every copy of the hot loops keeps to itself: a function two copies define under one name would be
# linked once, and the linker could pick the one this processor cannot run. Lists what each
# variant_<isa>.cpp.o defines for others to see, and fails on any function that is neither inside
# grelha::<isa>:: nor an xsimd template that carries the set's name.
# cmake -D NM=nm -D OBJECTS="a.o;b.o" -D FLAGS=of-the-compiler [-D SELF_TEST=object] -P
# isa_symbols.cmake
# It goes red when a hot header calls a non-inlined std:: function, or defines one outside its
# namespace; the self test shows it on an object that does both.

# Sets `strangers` to what `object`, compiled for `isa`, shares with other copies, and `count` to
# all it defines.
function(find_strangers object isa)
  execute_process(COMMAND ${NM} --defined-only --extern-only -C ${object} OUTPUT_VARIABLE out
    RESULT_VARIABLE failed)
  if(failed)
    message(FATAL_ERROR "cannot list ${object}")
  endif()
  string(REPLACE ";" "," out "${out}")
  string(REPLACE "\n" ";" lines "${out}")
  set(found "")
  set(n 0)
  foreach(line IN LISTS lines)
    # Kinds: T, W, V, u and i are functions or data that the linker may merge or that others can
    # name.
    if(NOT line MATCHES "^[0-9a-fA-F]* *([TtWwVuiDBR]) (.*)$")
      continue()
    endif()
    set(kind ${CMAKE_MATCH_1})
    set(name "${CMAKE_MATCH_2}")
    math(EXPR n "${n} + 1")
    if(name MATCHES "grelha::${isa}::" OR name MATCHES "xsimd::.*${isa}"
       OR name MATCHES "^(DW\\.ref\\.|__asan|__ubsan|__odr_asan)")
      continue()
    endif()
    list(APPEND found "${kind} ${name}")
  endforeach()
  set(strangers "${found}" PARENT_SCOPE)
  set(count ${n} PARENT_SCOPE)
endfunction()

if(SELF_TEST)
  find_strangers("${SELF_TEST}" scalar)
  list(JOIN strangers "\n" text)
  foreach(planted "shared_function" "std::vector" "grelha::sse2::other_copy")
    if(NOT text MATCHES "${planted}")
      message(FATAL_ERROR "planted symbol ${planted} was not found in\n${text}")
    endif()
  endforeach()
  if(text MATCHES "grelha::scalar::own")
    message(FATAL_ERROR "a function of the copy itself was taken for a stranger:\n${text}")
  endif()
  return()
endif()

set(seen 0)
set(wrong "")
foreach(object IN LISTS OBJECTS)
  if(NOT object MATCHES "variant_([a-z0-9_]+)\\.cpp")
    continue()
  endif()
  set(isa ${CMAKE_MATCH_1})
  math(EXPR seen "${seen} + 1")
  find_strangers(${object} ${isa})
  if(count EQUAL 0)
    message(FATAL_ERROR "${object} defines nothing at all")
  endif()
  foreach(s IN LISTS strangers)
    string(APPEND wrong "\n  ${isa}: ${s}")
  endforeach()
  message(STATUS "${isa}: ${count} symbols")
endforeach()
if(seen EQUAL 0)
  message(FATAL_ERROR "no variant_*.cpp among the objects: ${OBJECTS}")
endif()
if(wrong AND FLAGS MATCHES "-fsanitize=")
  message("SKIPPED: with what a sanitizer adds, the compiler no longer inlines all that a release "
    "does:${wrong}")
elseif(wrong)
  message(FATAL_ERROR "functions other copies may define too:${wrong}")
endif()
