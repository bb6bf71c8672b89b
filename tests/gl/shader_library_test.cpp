#include "limn/gl/shader_library.h"

#include <gtest/gtest.h>

#include "limn/gl/context.h"
#include "limn/gl/embedded_shaders.h"

#include "support/temp_folder.h"

namespace limn::gl {
namespace {

TEST(ShaderLibrary, BuiltInTextsAreTheFilesInTheShadersFolder) {
  ASSERT_FALSE(embedded_shaders().empty());
  for (const EmbeddedShader& shader : embedded_shaders()) {
    EXPECT_EQ(shader.text, test::slurp(std::filesystem::path(LIMN_SOURCE_DIR) / "shaders" / shader.name))
        << shader.name;
  }
}

TEST(ShaderLibrary, IncludesEachFileOnceAndKeepsLineNumbers) {
  const test::TempFolder folder;
  folder.write("a.glsl", "#version 450 core\n#include \"b.glsl\"\n#include \"c.glsl\"\nend\n");
  folder.write("b.glsl", "in b\n");
  folder.write("c.glsl", "#include \"b.glsl\"\nin c\n");
  const auto text = ShaderLibrary(folder.path()).source("a.glsl", {"X 3"});
  ASSERT_TRUE(text) << format_error(text.error());
  EXPECT_EQ(
      *text,
      "#version 450 core\n#define X 3\n#line 2 0\n#line 1 1\nin b\n#line 3 0\n#line 1 2\n#line 1 3\n#line 2 2\nin c\n"
      "#line 4 0\nend\n");
}

TEST(ShaderLibrary, AMissingFileIsNamed) {
  const test::TempFolder folder;
  const auto text = ShaderLibrary(folder.path()).source("none.glsl");
  ASSERT_FALSE(text);
  EXPECT_NE(text.error().file.find("none.glsl"), std::string::npos);
  EXPECT_FALSE(ShaderLibrary().source("none.glsl"));
}

TEST(ShaderFolder, IsReadAnewAndABrokenShaderGivesTheDriversLog) {
  const test::TempFolder folder;
  folder.write("v.glsl", "#version 450 core\nvoid main() { gl_Position = vec4(0.0); }\n");
  folder.write("f.glsl", "#version 450 core\nout vec4 c;\nvoid main() { c = undeclared_thing; }\n");
  const auto context = Context::create({folder.path()});
  ASSERT_TRUE(context) << format_error(context.error());
  const ProgramFiles files{"v.glsl", "", "f.glsl", {}};
  const auto broken = (*context)->program(files);
  ASSERT_FALSE(broken);
  EXPECT_EQ(broken.error().code, ErrorCode::kNoGraphics);
  EXPECT_NE(broken.error().message.find("undeclared_thing"), std::string::npos) << broken.error().message;
  folder.write("f.glsl", "#version 450 core\nout vec4 c;\nvoid main() { c = vec4(1.0); }\n");
  EXPECT_TRUE((*context)->program(files));
}

TEST(ShaderFolder, StagesThatDoNotFitGiveTheLinkersLog) {
  const test::TempFolder folder;
  folder.write("v.glsl", "#version 450 core\nvoid main() { gl_Position = vec4(0.0); }\n");
  folder.write("f.glsl",
               "#version 450 core\nlayout(location = 0) in vec2 never_given;\nout vec4 c;\nvoid main() { c = "
               "never_given.xyxy; }\n");
  const auto context = Context::create({folder.path()});
  ASSERT_TRUE(context) << format_error(context.error());
  const auto program = (*context)->program({"v.glsl", "", "f.glsl", {}});
  ASSERT_FALSE(program);
  EXPECT_NE(program.error().message.find("link"), std::string::npos);
}

}  // namespace
}  // namespace limn::gl
