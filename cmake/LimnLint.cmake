# The layout of the code as a test. Once is enough: sanitizer and coverage builds leave it out, and so do machines without
# the tool. clang-tidy takes minutes: it is part of `make lint`, which continuous integration runs before the tests.
if(LIMN_SANITIZE OR LIMN_COVERAGE)
  return()
endif()

find_program(LIMN_CLANG_FORMAT NAMES clang-format-14)

if(LIMN_CLANG_FORMAT)
  add_test(NAME lint.format COMMAND ${PROJECT_SOURCE_DIR}/scripts/format --check)
  set_tests_properties(lint.format PROPERTIES LABELS lint)
else()
  message(STATUS "clang-format 14 was not found: the layout of the code will not be tested")
endif()
