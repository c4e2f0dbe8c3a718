# The man page and the completions as a shell and man(1) take them.
add_test(NAME pages COMMAND bash ${CMAKE_CURRENT_LIST_DIR}/pages.sh ${GRELHA_PAGES} $<TARGET_FILE:grelha>)
set_tests_properties(pages PROPERTIES LABELS build)
