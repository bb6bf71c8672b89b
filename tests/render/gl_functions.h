#pragma once

// The OpenGL functions whose calls tests count, without their "gl": all that the library uses (a test compares them
// with its sources), and those that would wait for the device, read it or do in another way what the library does.
// clang-format off
#define LIMN_TEST_GL_FUNCTIONS(X) \
  X(ActiveTexture) X(AttachShader) X(BeginConditionalRender) X(BeginQuery) X(BeginTransformFeedback) \
  X(BindBuffer) X(BindBufferBase) X(BindBufferRange) X(BindBuffersBase) X(BindFramebuffer) X(BindImageTexture) \
  X(BindImageTextures) X(BindSampler) X(BindTexture) X(BindTextureUnit) X(BindTextures) \
  X(BindTransformFeedback) X(BindVertexArray) X(BlendEquation) X(BlendFunc) X(BlitNamedFramebuffer) \
  X(BufferData) X(BufferStorage) X(BufferSubData) X(CheckNamedFramebufferStatus) X(Clear) X(ClearBufferData) \
  X(ClearBufferfv) X(ClearColor) X(ClearNamedBufferData) X(ClearNamedFramebufferfi) X(ClearNamedFramebufferfv) \
  X(ClearTexImage) X(ClientWaitSync) X(ColorMask) X(CompileShader) X(CopyBufferSubData) \
  X(CopyNamedBufferSubData) X(CreateBuffers) X(CreateFramebuffers) X(CreateProgram) X(CreateQueries) \
  X(CreateShader) X(CreateTextures) X(CreateTransformFeedbacks) X(CreateVertexArrays) X(CullFace) \
  X(DebugMessageCallback) X(DebugMessageControl) X(DeleteBuffers) X(DeleteFramebuffers) X(DeleteProgram) \
  X(DeleteQueries) X(DeleteShader) X(DeleteSync) X(DeleteTextures) X(DeleteTransformFeedbacks) \
  X(DeleteVertexArrays) X(DepthFunc) X(DepthMask) X(Disable) X(DispatchCompute) X(DispatchComputeIndirect) \
  X(DrawArrays) X(DrawArraysIndirect) X(DrawArraysInstanced) X(DrawArraysInstancedBaseInstance) \
  X(DrawElements) X(DrawElementsBaseVertex) X(DrawElementsIndirect) X(DrawElementsInstanced) \
  X(DrawElementsInstancedBaseInstance) X(DrawElementsInstancedBaseVertexBaseInstance) X(DrawTransformFeedback) \
  X(Enable) X(EnableVertexArrayAttrib) X(EndQuery) X(EndTransformFeedback) X(FenceSync) X(Finish) X(Flush) \
  X(FlushMappedBufferRange) X(FlushMappedNamedBufferRange) X(GenerateTextureMipmap) X(GetActiveUniform) \
  X(GetAttribLocation) X(GetBooleanv) X(GetBufferParameteriv) X(GetBufferPointerv) X(GetBufferSubData) \
  X(GetCompressedTexImage) X(GetDoublev) X(GetError) X(GetFloatv) X(GetInteger64i_v) X(GetInteger64v) \
  X(GetIntegeri_v) X(GetIntegerv) X(GetNamedBufferParameteriv) X(GetNamedBufferPointerv) \
  X(GetNamedBufferSubData) X(GetObjectLabel) X(GetProgramInfoLog) X(GetProgramInterfaceiv) \
  X(GetProgramResourceIndex) X(GetProgramResourceLocation) X(GetProgramiv) X(GetQueryBufferObjectui64v) \
  X(GetQueryBufferObjectuiv) X(GetQueryObjecti64v) X(GetQueryObjectiv) X(GetQueryObjectui64v) \
  X(GetQueryObjectuiv) X(GetQueryiv) X(GetShaderInfoLog) X(GetShaderiv) X(GetString) X(GetStringi) \
  X(GetSynciv) X(GetTexImage) X(GetTextureImage) X(GetTextureSubImage) X(GetUniformBlockIndex) \
  X(GetUniformLocation) X(GetUniformfv) X(GetUniformiv) X(GetUniformuiv) X(GetVertexAttribiv) X(GetnTexImage) \
  X(InvalidateBufferData) X(LinkProgram) X(MapBuffer) X(MapBufferRange) X(MapNamedBuffer) \
  X(MapNamedBufferRange) X(MemoryBarrier) X(MultiDrawArrays) X(MultiDrawArraysIndirect) X(MultiDrawElements) \
  X(MultiDrawElementsIndirect) X(NamedBufferData) X(NamedBufferStorage) X(NamedBufferSubData) \
  X(NamedFramebufferParameteri) X(NamedFramebufferTexture) X(PatchParameteri) X(PixelStorei) \
  X(ProgramUniform1f) X(ProgramUniform1fv) X(ProgramUniform1i) X(ProgramUniform1iv) X(ProgramUniform1ui) \
  X(ProgramUniform1uiv) X(ProgramUniform2fv) X(ProgramUniform2iv) X(ProgramUniform3fv) X(ProgramUniform4fv) \
  X(ProgramUniform4uiv) X(ProgramUniformMatrix4fv) X(QueryCounter) X(ReadPixels) X(ReadnPixels) X(Scissor) \
  X(ShaderSource) X(StencilFunc) X(StencilMask) X(StencilOp) X(StencilOpSeparate) X(TextureBuffer) \
  X(TextureParameteri) X(TextureStorage2D) X(TextureStorage2DMultisample) X(TextureStorage3D) \
  X(TextureSubImage2D) X(TextureSubImage3D) X(TransformFeedbackBufferBase) X(TransformFeedbackVaryings) \
  X(Uniform1f) X(Uniform1i) X(Uniform1iv) X(Uniform1ui) X(Uniform2f) X(Uniform3f) X(Uniform4f) X(Uniform4fv) \
  X(UniformMatrix4fv) X(UnmapBuffer) X(UnmapNamedBuffer) X(UseProgram) X(VertexArrayAttribBinding) \
  X(VertexArrayAttribFormat) X(VertexArrayAttribIFormat) X(VertexArrayBindingDivisor) \
  X(VertexArrayElementBuffer) X(VertexArrayVertexBuffer) X(VertexAttrib4f) X(Viewport) X(WaitSync)
// clang-format on
