/// Small Jobs with hand-written GLSL for the tests of the OpenGL backend.
#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "relievo/backend.hpp"

namespace relievo::opengl_jobs {

template <class T>
std::vector<std::byte> to_bytes(const std::vector<T>& values) {
  std::vector<std::byte> bytes(values.size() * sizeof(T));
  std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

template <class T>
std::vector<T> from_bytes(const std::vector<std::byte>& bytes) {
  std::vector<T> values(bytes.size() / sizeof(T));
  std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
  return values;
}

template <class T>
Buffer make_buffer(const std::string& name, const std::vector<T>& values) {
  return {name, values.size() * sizeof(T), to_bytes(values)};
}

inline ShaderCode make_shader(ShaderStage stage, const std::string& body) {
  return {stage, {}, {{"glsl-450", "#version 450\n" + body}}};
}

inline BindingSlot storage_slot(int binding, const std::string& name) {
  return {ResourceKind::storage_buffer, 0, binding, name, binding};
}

inline BindingSlot texture_slot(int binding, const std::string& name) {
  return {ResourceKind::sampled_texture, 0, binding, name, binding};
}

/// A job of one dispatch of 1x1x1 groups that writes `output_bytes` to the block `Out` at binding 0, which is read
/// back.
inline Job compute_job(const std::string& body, std::size_t output_bytes) {
  Job job;
  job.name = "compute";
  job.programs = {{"body", {make_shader(ShaderStage::compute, body)}, {storage_slot(0, "Out")}, {}}};
  job.buffers = {{"out", output_bytes, {}}};
  job.commands = {Dispatch{0, {{0, 0, 0}}, {1, 1, 1}}};
  job.read_backs = {{ReadBack::Source::buffer, 0, 0}};
  return job;
}

/// Adds a texture to compute_job's program and dispatch.
inline void sample_texture(Job& job, const std::string& name, Texture texture) {
  const int binding = static_cast<int>(job.programs[0].bindings.size());
  job.programs[0].bindings.push_back(texture_slot(binding, name));
  std::get<Dispatch>(job.commands[0]).resources.push_back({0, binding, static_cast<int>(job.textures.size())});
  job.textures.push_back(std::move(texture));
}

/// With debug output unless told otherwise.
inline std::unique_ptr<Backend> open_opengl(bool validation = true) {
  BackendOptions options;
  options.validation = validation;
  auto backend = open_backend("opengl", options);
  EXPECT_TRUE(backend) << format(backend.error());
  return backend ? std::move(*backend) : nullptr;
}

/// Runs with debug output on and expects it to stay silent.
inline JobResult run(Backend& backend, const Job& job) {
  auto result = backend.execute(job);
  EXPECT_TRUE(result) << format(result.error());
  if (!result) return {};
  for (const std::string& message : result->messages) ADD_FAILURE() << message;
  return std::move(*result);
}

inline JobResult run(const Job& job) {
  const auto backend = open_opengl();
  return backend ? run(*backend, job) : JobResult{};
}

}  // namespace relievo::opengl_jobs
