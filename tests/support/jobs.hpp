/// Making small jobs and running them on Vulkan, with validation.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "relievo/backend.hpp"
#include "support/glsl.hpp"

namespace relievo::test {

using Bytes = std::vector<std::byte>;

template <class T>
Bytes to_bytes(const std::vector<T>& values) {
  Bytes bytes(values.size() * sizeof(T));
  if (!values.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

template <class T>
std::vector<T> from_bytes(const Bytes& bytes) {
  std::vector<T> values(bytes.size() / sizeof(T));
  if (!values.empty()) std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
  return values;
}

inline Buffer make_buffer(std::string name, std::size_t size) {
  return {std::move(name), size, {}};
}

template <class T>
Buffer make_buffer(std::string name, const std::vector<T>& values) {
  return {std::move(name), values.size() * sizeof(T), to_bytes(values)};
}

inline Texture make_texture(std::string name, Format format, int width, int height, int depth = 1) {
  Texture texture;
  texture.name = std::move(name);
  texture.format = format;
  texture.width = width;
  texture.height = height;
  texture.depth = depth;
  texture.is_3d = depth > 1;
  texture.sampler.min_mag = TexelFilter::nearest;
  return texture;
}

/// One compute program whose first slot is a storage buffer "Result" at set 0, binding 0.
inline ShaderProgram make_compute(std::string name, const std::string& body, std::vector<BindingSlot> slots = {}) {
  slots.insert(slots.begin(), {ResourceKind::storage_buffer, 0, 0, "Result", 0});
  return {std::move(name), {compile_glsl(ShaderStage::compute, body)}, std::move(slots), {}};
}

/// A job of one dispatch over buffer 0, which is `size` bytes and read back.
inline Job make_compute_job(ShaderProgram program, std::size_t size) {
  Job job;
  job.name = program.name;
  job.buffers = {make_buffer("result", size)};
  job.commands = {Dispatch{0, {{0, 0, 0}}, {1, 1, 1}}};
  job.read_backs = {{ReadBack::Source::buffer, 0, 0}};
  job.programs = {std::move(program)};
  return job;
}

/// The Vulkan backend with validation; opened once for all tests.
inline Backend& vulkan() {
  static const Result<std::unique_ptr<Backend>> backend = open_backend(
      "vulkan", {.validation = true, .device = {}, .pipeline_cache = {}, .copies_always = false, .fail_at_call = -1});
  if (!backend) throw std::runtime_error(backend.error().message);
  return **backend;
}

/// Runs a job that must succeed without a single message.
inline JobResult run(const Job& job) {
  Result<JobResult> result = vulkan().execute(job);
  if (!result) {
    ADD_FAILURE() << result.error().message;
    return {std::vector<Bytes>(job.read_backs.size()), {}, {}};
  }
  EXPECT_THAT(result->messages, testing::IsEmpty());
  return *std::move(result);
}

}  // namespace relievo::test
