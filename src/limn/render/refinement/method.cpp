#include "limn/render/refinement/method.h"

#include <algorithm>

namespace limn {

Result<const gl::Program*> surface_program(const RefinementScene& scene, const SurfaceProgram& stages,
                                           const SurfacePass& pass) {
  gl::ProgramFiles files;
  files.vertex = stages.vertex;
  files.tessellation_control = stages.tessellation_control;
  files.tessellation_evaluation = stages.tessellation_evaluation;
  files.geometry = stages.geometry;
  files.defines = stages.defines;
  files.captured = pass.captured;
  if (!pass.captured.empty()) files.defines.emplace_back("CAPTURED 1");
  if (pass.stage == SurfaceStage::kPositions) {
    files.defines.emplace_back("POSITIONS_ONLY 1");
  } else {
    files.fragment = "face.frag.glsl";
    if (scene.has_uvs()) files.defines.emplace_back("HAS_UVS 1");
    if (scene.has_colors()) files.defines.emplace_back("HAS_COLORS 1");
    if (scene.has_materials()) files.defines.emplace_back("HAS_MATERIALS 1");
    if (pass.wireframe && files.geometry.empty()) {
      files.geometry = "wire.geom.glsl";
      files.defines.emplace_back("WIREFRAME 1");
    }
  }
  const auto program = scene.context().program(files);
  if (!program) return tl::unexpected(program.error());
  return *program;
}

Result<const gl::Program*> SurfacePrograms::use(const RefinementScene& scene, const SurfacePass& pass) {
  const auto found = std::find_if(made_.begin(), made_.end(), [&](const Made& made) {
    return made.stage == pass.stage && made.flat_normals == pass.flat_normals && made.wireframe == pass.wireframe &&
           made.captured == pass.captured;
  });
  const gl::Program* program = found != made_.end() ? found->program : nullptr;
  if (program == nullptr) {
    const auto made = surface_program(scene, stages_, pass);
    if (!made) return tl::unexpected(made.error());
    program = *made;
    made_.push_back({pass.stage, pass.flat_normals, pass.wireframe, pass.captured, program});
  }
  program->use();
  program->set("flat_normals", pass.flat_normals ? 1 : 0);
  program->set("draw_faces", 1);
  return program;
}

}  // namespace limn
