#include "limn/base/file.h"

#include <gtest/gtest.h>

#include "support/temp_folder.h"

namespace limn {
namespace {

using test::slurp;
using test::TempFolder;

TEST(WriteFile, ReplacesAFileWholeAndKeepsItsPermissions) {
  const TempFolder folder;
  const auto path = folder.write("a", "old");
  constexpr auto kMode = std::filesystem::perms::owner_all | std::filesystem::perms::group_read;
  std::filesystem::permissions(path, kMode);
  ASSERT_TRUE(write_file(path, "new content"));
  EXPECT_EQ(slurp(path), "new content");
  EXPECT_EQ(std::filesystem::status(path).permissions(), kMode);
}

TEST(WriteFile, LeavesNothingBehindWhenItFails) {
  const TempFolder folder;
  const auto result = write_file(folder / "no-such-folder/a", "text");
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ErrorCode::kUnwritable);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  EXPECT_FALSE(write_file(folder.path(), "text"));
}

TEST(WriteFile, FollowsALinkAndKeepsIt) {
  const TempFolder folder;
  const auto target = folder.write("target", "old");
  std::filesystem::create_symlink(target, folder / "link");
  ASSERT_TRUE(write_file(folder / "link", "new"));
  EXPECT_EQ(slurp(target), "new");
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
}

TEST(WriteFile, MakesTheFileADanglingLinkNames) {
  const TempFolder folder;
  std::filesystem::create_symlink("target", folder / "link");
  ASSERT_TRUE(write_file(folder / "link", "new"));
  EXPECT_EQ(slurp(folder / "target"), "new");
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
}

TEST(WriteFile, WritesIntoADevice) {
  EXPECT_TRUE(write_file("/dev/null", "text"));
}

TEST(FileBytes, ReadsFilesAndRefusesDirectories) {
  const TempFolder folder;
  const auto full = FileBytes::open(folder.write("full", "abc"));
  ASSERT_TRUE(full);
  EXPECT_EQ(full->text(), "abc");
  const auto empty = FileBytes::open(folder.write("empty", ""));
  ASSERT_TRUE(empty);
  EXPECT_EQ(empty->bytes().size(), 0u);
  const auto directory = FileBytes::open(folder.path());
  ASSERT_FALSE(directory);
  EXPECT_EQ(directory.error().message, "is a directory");
  const auto absent = FileBytes::open(folder / "absent");
  ASSERT_FALSE(absent);
  EXPECT_EQ(absent.error().code, ErrorCode::kUnreadable);
}

}  // namespace
}  // namespace limn
