#include "limn/gl/context.h"

#include <cstdlib>
#include <gtest/gtest.h>
#include <string>

namespace limn::gl {
namespace {

TEST(Context, SaysWhatItRunsOn) {
  const auto context = Context::create();
  ASSERT_TRUE(context) << format_error(context.error());
  EXPECT_FALSE((*context)->renderer().empty());
  EXPECT_FALSE((*context)->platform().empty());
  const std::string& version = (*context)->version();
  ASSERT_GE(version.size(), 3u);
  EXPECT_GE(version.substr(0, 3), "4.5");
  EXPECT_EQ((*context)->severe_messages(), 0) << (*context)->last_severe_message();
}

TEST(Context, TwoOnOneThreadTakeTurns) {
  const ProgramFiles files{"fullscreen.vert.glsl", "", "resolve.frag.glsl", {"MULTISAMPLE 0"}};
  auto first = Context::create();
  auto second = Context::create();
  ASSERT_TRUE(first && second);
  EXPECT_TRUE((*first)->program(files));
  (*second)->make_current();
  EXPECT_TRUE((*second)->program(files));
  first->reset();
  EXPECT_TRUE((*second)->program({"fullscreen.vert.glsl", "", "resolve.frag.glsl", {"MULTISAMPLE 4"}}));
  EXPECT_EQ((*second)->severe_messages(), 0) << (*second)->last_severe_message();
}

TEST(Context, AProgramIsMadeOnce) {
  const auto context = Context::create();
  ASSERT_TRUE(context);
  const ProgramFiles files{"fullscreen.vert.glsl", "", "resolve.frag.glsl", {"MULTISAMPLE 0"}};
  const auto first = (*context)->program(files);
  const auto again = (*context)->program(files);
  ASSERT_TRUE(first && again) << format_error(first.error());
  EXPECT_EQ(*first, *again);
}

/// Runs in a child whose EGL library finds no driver; leaves with 0 when that is reported as it should be.
void create_without_drivers() {
  ::setenv("__EGL_VENDOR_LIBRARY_FILENAMES", "/dev/null", 1);
  const auto context = Context::create();
  if (context) std::exit(1);
  const Error& error = context.error();
  const bool told = error.code == ErrorCode::kNoGraphics &&
                    error.message.find("default display") != std::string::npos &&
                    error.remedy.find("libegl1") != std::string::npos &&
                    error.remedy.find("LIBGL_ALWAYS_SOFTWARE=1") != std::string::npos;
  std::exit(told ? 0 : 2);
}

TEST(ContextDeathTest, WithoutAnyDriverTheErrorSaysWhatWasTriedAndWhatHelps) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(create_without_drivers(), testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace limn::gl
