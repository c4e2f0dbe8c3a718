# The man page and the completions as a shell and man(1) take them.
add_test(NAME pages COMMAND bash ${CMAKE_CURRENT_LIST_DIR}/pages.sh ${GRELHA_PAGES}
  $<TARGET_FILE:grelha>)
set_tests_properties(pages PROPERTIES LABELS build)

# The site builds without a warning, and its picture of what includes what is of these sources;
# without the tools both skip, and say so.
add_test(NAME docs COMMAND sh ${CMAKE_CURRENT_LIST_DIR}/with_python.sh
  ${PROJECT_SOURCE_DIR}/docs/make_site.py ${CMAKE_CURRENT_BINARY_DIR}/docs)
add_test(NAME architecture COMMAND sh ${CMAKE_CURRENT_LIST_DIR}/with_python.sh
  ${PROJECT_SOURCE_DIR}/docs/architecture.py --check)
# Files and test cases that docs and comments name are there, and includes point one way. The self
# tests plant offences.
foreach(rule references layering)
  set(command sh ${CMAKE_CURRENT_LIST_DIR}/with_python.sh ${CMAKE_CURRENT_LIST_DIR}/${rule}.py)
  add_test(NAME ${rule} COMMAND ${command} ${PROJECT_SOURCE_DIR})
  add_test(NAME ${rule}_self_test COMMAND ${command} --self-test)
  set_tests_properties(${rule} ${rule}_self_test PROPERTIES LABELS build SKIP_RETURN_CODE 77)
endforeach()
set_tests_properties(docs architecture PROPERTIES LABELS build SKIP_RETURN_CODE 77)

# Figures of prose are those of the CSVs, and each CSV says of what commit and machine it is.
add_test(NAME figures COMMAND sh ${CMAKE_CURRENT_LIST_DIR}/with_python.sh
  ${PROJECT_SOURCE_DIR}/perf/figures.py --check)
set_tests_properties(figures PROPERTIES LABELS build SKIP_RETURN_CODE 77)

# Each fault of plant.py can be planted.
add_test(NAME faults COMMAND sh ${CMAKE_CURRENT_LIST_DIR}/with_python.sh
  ${CMAKE_CURRENT_LIST_DIR}/plant.py --list)
set_tests_properties(faults PROPERTIES LABELS build SKIP_RETURN_CODE 77)

add_test(NAME summary COMMAND sh ${CMAKE_CURRENT_LIST_DIR}/with_python.sh
  ${CMAKE_CURRENT_LIST_DIR}/summary.py --self-test)
set_tests_properties(summary PROPERTIES LABELS build SKIP_RETURN_CODE 77)

# Every source has the form that CONTRIBUTING.md asks for. The self test plants offences.
set(form sh ${CMAKE_CURRENT_LIST_DIR}/with_python.sh ${CMAKE_CURRENT_LIST_DIR}/form.py)
foreach(rules text functions format)
  add_test(NAME form_${rules} COMMAND ${form} ${rules} ${PROJECT_SOURCE_DIR})
endforeach()
add_test(NAME form_self_test COMMAND ${form} --self-test ${CMAKE_CURRENT_BINARY_DIR}/form)
set_tests_properties(form_text form_functions form_format form_self_test PROPERTIES
  LABELS build SKIP_RETURN_CODE 77)

# ./run through a link, and where nothing may be installed.
add_test(NAME run_script COMMAND sh ${CMAKE_CURRENT_LIST_DIR}/run_script.sh
  ${PROJECT_SOURCE_DIR}/run ${CMAKE_CURRENT_BINARY_DIR}/run_script)
set_tests_properties(run_script PROPERTIES LABELS build)
