// What a surface looks like: normals, colours, materials, textures, both sides.
#include <algorithm>
#include <array>
#include <cmath>

#include "limn/mesh/shapes.h"

#include "drawing_test.h"

namespace limn {
namespace {

using test::kTransparent;
using test::kWhite;
using test::picture_options;
using test::pixel_camera;
using test::png_of;
using test::rectangle;

class Surface : public test::DrawingTest {
 protected:
  Image draw_small(const Mesh& mesh) { return draw(mesh, pixel_camera(16, 16), picture_options(16, 16, 1, kWhite)); }
};

/// 2 x 2 blocks of 8 pixels, rows from the top: red, green; blue, white.
Image four_colors() {
  Image image(16, 16);
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 16; ++x) {
      std::uint8_t* const pixel = image.pixel(x, y);
      const bool right = x >= 8, low = y >= 8;
      pixel[0] = low == right ? 255 : 0;
      pixel[1] = right ? 255 : 0;
      pixel[2] = low ? 255 : 0;
      pixel[3] = 255;
    }
  }
  return image;
}

TEST_F(Surface, ATextureLiesUprightWithVUpwards) {
  Mesh mesh = rectangle(Vec2(0, 0), Vec2(16, 16));
  Material& material = mesh.materials.emplace_back();
  material.base_color = Vec4(1, 1, 1, 1);
  material.base_color_image = png_of(four_colors());
  material.base_color_image_mime = "image/png";
  const Image image = draw_small(mesh);
  const auto strongest = [&](int x, int y) {
    const std::uint8_t* const p = image.pixel(x, y);
    return std::max_element(p, p + 3) - p;
  };
  EXPECT_EQ(strongest(3, 3), 0);
  EXPECT_EQ(strongest(12, 3), 1);
  EXPECT_EQ(strongest(3, 12), 2);
  EXPECT_GT(std::min({image.pixel(12, 12)[0], image.pixel(12, 12)[1], image.pixel(12, 12)[2]}), 100);
}

TEST_F(Surface, ATextureIsReadAsSrgb) {
  Image grey(4, 4);
  for (std::uint8_t& channel : grey.rgba)
    channel = 188;
  Mesh textured = rectangle(Vec2(0, 0), Vec2(16, 16));
  textured.materials.emplace_back().base_color = Vec4(1, 1, 1, 1);
  textured.materials[0].base_color_image = png_of(grey);
  Mesh plain = rectangle(Vec2(0, 0), Vec2(16, 16));
  const float linear = std::pow((188.0f / 255.0f + 0.055f) / 1.055f, 2.4f);
  plain.materials.emplace_back().base_color = Vec4(linear, linear, linear, 1);
  const Image a = draw_small(textured), b = draw_small(plain);
  EXPECT_EQ(compare_images(a, b, 1).failing_share, 0.0);
  EXPECT_LT(a.pixel(5, 5)[0], 250);
}

TEST_F(Surface, ABrokenTextureNamesItsMaterial) {
  Mesh mesh = rectangle(Vec2(0, 0), Vec2(16, 16));
  Material& material = mesh.materials.emplace_back();
  material.name = "bark";
  material.base_color_image.assign(40, std::byte{7});
  const auto image = render(*context_, mesh, pixel_camera(16, 16), picture_options(16, 16, 1, kWhite));
  ASSERT_FALSE(image);
  EXPECT_EQ(image.error().code, ErrorCode::kUnsuitable);
  EXPECT_NE(format_error(image.error()).find("bark"), std::string::npos);
}

/// A picture of one colour.
Image plain_picture(int width, int height, std::array<std::uint8_t, 3> rgb) {
  Image image(width, height);
  for (std::size_t i = 0; i < image.rgba.size(); ++i)
    image.rgba[i] = i % 4 == 3 ? 255 : rgb[i % 4];
  return image;
}

TEST_F(Surface, FacesThatShareVerticesKeepTheirOwnMaterials) {
  Mesh mesh = rectangle(Vec2(0, 0), Vec2(16, 16));
  mesh.face_materials = {2, 0};
  mesh.materials.resize(3);
  mesh.materials[0].base_color = Vec4(1, 0, 0, 1);
  mesh.materials[2].base_color = Vec4(0, 1, 0, 1);
  RenderOptions options = picture_options(16, 16, 1, kWhite);
  for (const bool wireframe : {false, true}) {
    options.wireframe = wireframe;
    const Image image = draw(mesh, pixel_camera(16, 16), options);
    const std::uint8_t* const low = image.pixel(10, 12);
    const std::uint8_t* const high = image.pixel(5, 3);
    EXPECT_GT(low[1], 3 * low[0]);
    EXPECT_GT(high[0], 3 * high[1]);
  }
}

TEST_F(Surface, PicturesOfDifferentSizesEachShowAsTheyWouldAlone) {
  constexpr int kSide = 64;
  Mesh left = rectangle(Vec2(0, 0), Vec2(kSide / 2, kSide)), right = rectangle(Vec2(kSide / 2, 0), Vec2(kSide, kSide));
  Material colors, plain;
  colors.base_color = plain.base_color = Vec4(1.0f);
  colors.base_color_image = png_of(four_colors());
  plain.base_color_image = png_of(plain_picture(5, 24, {200, 90, 30}));
  Mesh both = left;
  test::append(both, right);
  both.materials = {plain, colors, plain};
  both.face_materials = {1, 1, 2, 2};
  left.materials = {colors};
  right.materials = {plain};
  const auto draw_side = [&](const Mesh& mesh) {
    return draw(mesh, pixel_camera(kSide, kSide), picture_options(kSide, kSide, 1, kWhite));
  };
  const Image image = draw_side(both), left_alone = draw_side(left), right_alone = draw_side(right);
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      // Colours meet there, and mix a little differently.
      if (x < 32 && (x % 16 < 3 || x % 16 >= 13 || y % 32 < 5 || y % 32 >= 27)) continue;
      const std::uint8_t* const expected = (x < 32 ? left_alone : right_alone).pixel(x, y);
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(image.pixel(x, y)[c], expected[c], 2) << x << ", " << y;
    }
  }
}

TEST_F(Surface, VertexColoursMultiplyTheBaseColour) {
  Mesh tinted = rectangle(Vec2(0, 0), Vec2(16, 16));
  tinted.materials.emplace_back().base_color = Vec4(0.5f, 0.8f, 0.9f, 1);
  tinted.colors.values.assign(4, Vec4(0.5f, 0.25f, 1.0f, 1));
  Mesh plain = rectangle(Vec2(0, 0), Vec2(16, 16));
  plain.materials.emplace_back().base_color = Vec4(0.25f, 0.2f, 0.9f, 1);
  EXPECT_EQ(compare_images(draw_small(tinted), draw_small(plain), 1).failing_share, 0.0);
}

TEST_F(Surface, BothSidesAreLitAlike) {
  Mesh back = rectangle(Vec2(0, 0), Vec2(16, 16));
  const Image front_image = draw_small(back);
  for (Triangle& face : back.faces)
    std::swap(face[1], face[2]);
  EXPECT_EQ(draw_small(back).rgba, front_image.rgba);
  back.normals.values.assign(4, Vec3(0, 0, -1));
  EXPECT_EQ(compare_images(draw_small(back), front_image, 1).failing_share, 0.0);
}

TEST_F(Surface, CornersWithIndicesOfTheirOwnLookLikeVerticesWithValues) {
  const auto knot = make_shape(Shape::kKnot, {600, 1});
  ASSERT_TRUE(knot);
  Mesh by_vertex = *knot;
  by_vertex.uvs = {};
  ASSERT_TRUE(!by_vertex.normals.empty());
  Mesh by_corner = by_vertex;
  by_corner.normals = {};
  for (FaceId f = 0; f < by_vertex.face_count(); ++f) {
    for (int c = 0; c < 3; ++c) {
      by_corner.normals.indices.push_back(static_cast<std::uint32_t>(by_corner.normals.values.size()));
      by_corner.normals.values.push_back(by_vertex.corner(by_vertex.normals, f, c));
    }
  }
  const Camera camera = fit_camera(face_bounds(by_vertex), 0.4f, 0.3f);
  const RenderOptions options = picture_options(96, 96, 4, kTransparent);
  EXPECT_EQ(draw(by_vertex, camera, options).rgba, draw(by_corner, camera, options).rgba);
}

TEST_F(Surface, FlatIgnoresTheMeshsNormals) {
  Mesh mesh = rectangle(Vec2(0, 0), Vec2(16, 16));
  const Image flat = draw_small(mesh);
  mesh.normals.values.assign(4, Vec3(0.8f, 0.0f, 0.6f));
  RenderOptions options = picture_options(16, 16, 1, kWhite);
  EXPECT_NE(draw(mesh, pixel_camera(16, 16), options).rgba, flat.rgba);
  options.flat = true;
  EXPECT_EQ(draw(mesh, pixel_camera(16, 16), options).rgba, flat.rgba);
}

TEST_F(Surface, FarFromTheOriginThePictureIsTheSame) {
  // Powers of two on a coarse grid, so that moving the mesh itself rounds nothing.
  Mesh here;
  here.positions = {Vec3(-1, -1, 0), Vec3(1, -0.5f, 0.5f), Vec3(0.25f, 1, -0.5f)};
  here.faces = {{0, 1, 2}};
  Mesh there = here;
  const Vec3 far_away(65536.0f, -32768.0f, 131072.0f);
  for (Vec3& p : there.positions)
    p += far_away;
  Camera camera;
  Camera moved = camera;
  moved.eye += far_away;
  moved.target += far_away;
  const RenderOptions options = picture_options(64, 64, 4, kTransparent);
  EXPECT_EQ(draw(here, camera, options).rgba, draw(there, moved, options).rgba);
}

TEST_F(Surface, TinyAndHugeModelsLookLikeThoseOfUnitSize) {
  const auto knot = make_shape(Shape::kKnot, {1000, 1});
  ASSERT_TRUE(knot);
  const RenderOptions options = picture_options(96, 96, 4, kTransparent);
  const Image expected = draw(*knot, fit_camera(face_bounds(*knot), 0.5f, 0.5f), options);
  for (const int exponent : {-100, -30, 40, 100}) {
    Mesh scaled = *knot;
    for (Vec3& p : scaled.positions)
      p *= std::ldexp(1.0f, exponent);
    const Image seen = draw(scaled, fit_camera(face_bounds(scaled), 0.5f, 0.5f), options);
    EXPECT_LT(compare_images(seen, expected, 8).failing_share, 0.005) << "2^" << exponent;
  }
}

TEST_F(Surface, TheSamePictureTwiceHasTheSameBits) {
  const auto torus = make_shape(Shape::kTorus, {2000, 1});
  ASSERT_TRUE(torus);
  const Camera camera = fit_camera(face_bounds(*torus), 0.5f, 0.5f);
  RenderOptions options = picture_options(128, 128, 4, kTransparent);
  options.wireframe = true;
  const Image first = draw(*torus, camera, options);
  EXPECT_EQ(draw(*torus, camera, options).rgba, first.rgba);
  const auto other = gl::Context::create();
  ASSERT_TRUE(other);
  const auto again = render(**other, *torus, camera, options);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->rgba, first.rgba);
  EXPECT_EQ(draw(*torus, camera, options).rgba, first.rgba);  // the first context is made current again
}

}  // namespace
}  // namespace limn
