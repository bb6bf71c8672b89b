# The layout of the code and clang-tidy's findings as tests (label: lint). Once is enough: sanitizer and coverage builds
# leave them out, and so do machines without the tools.
if(LIMN_SANITIZE OR LIMN_COVERAGE)
  return()
endif()

find_program(LIMN_CLANG_FORMAT NAMES clang-format-14)
find_program(LIMN_CLANG_TIDY NAMES clang-tidy)

if(LIMN_CLANG_FORMAT)
  add_test(NAME lint.format COMMAND ${PROJECT_SOURCE_DIR}/scripts/format --check)
  set_tests_properties(lint.format PROPERTIES LABELS lint)
else()
  message(STATUS "clang-format 14 was not found: the layout of the code will not be tested")
endif()

if(LIMN_CLANG_TIDY AND CMAKE_EXPORT_COMPILE_COMMANDS)
  include(ProcessorCount)
  ProcessorCount(cores)
  add_test(NAME lint.tidy COMMAND ${PROJECT_SOURCE_DIR}/scripts/tidy ${PROJECT_BINARY_DIR})
  set_tests_properties(lint.tidy PROPERTIES LABELS lint PROCESSORS ${cores} TIMEOUT 900)
else()
  message(STATUS "clang-tidy was not found: its findings will not be tested")
endif()
