# Flags every limn target is built with, and none that a consumer inherits.
if(NOT CMAKE_BUILD_TYPE AND PROJECT_IS_TOP_LEVEL)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()

find_program(LIMN_CCACHE ccache)
if(LIMN_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER AND PROJECT_IS_TOP_LEVEL)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${LIMN_CCACHE})
endif()

add_library(limn_build_flags INTERFACE)
target_compile_features(limn_build_flags INTERFACE cxx_std_20)
# -ffp-contract=off: the same bits from scalar, SIMD and GPU code need multiplications and additions kept apart (docs/architecture.md).
target_compile_options(limn_build_flags INTERFACE -ffp-contract=off -Wall -Wextra -Wpedantic -Wshadow -Wconversion
                       -Wno-sign-conversion -Wnon-virtual-dtor -Wold-style-cast)
if(LIMN_WERROR)
  target_compile_options(limn_build_flags INTERFACE -Werror)
endif()
if(LIMN_SANITIZE)
  target_compile_options(limn_build_flags INTERFACE -fsanitize=${LIMN_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(limn_build_flags INTERFACE -fsanitize=${LIMN_SANITIZE})
endif()
if(LIMN_COVERAGE)
  target_compile_options(limn_build_flags INTERFACE --coverage)
  target_link_options(limn_build_flags INTERFACE --coverage)
endif()
