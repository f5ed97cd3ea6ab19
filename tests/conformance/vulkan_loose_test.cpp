/// The backend whose arithmetic is as inexact as Vulkan permits: inexact indeed, and no more than that.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "support/jobs.hpp"
#include "support/pipeline.hpp"

namespace relievo::test {
namespace {

constexpr std::size_t threads = 4096;

/// Runs `statement`, which sets result[i] from the number i and floats a and b in [1, 2) and [1, 4).
std::vector<float> run_loose(const std::string& statement) {
  Job job = make_compute_job(make_compute("loose", R"(
layout(local_size_x = 64) in;
layout(std430, set = 0, binding = 0) buffer Result { float result[]; };
float in_bits(uint i, uint exponents) { return uintBitsToFloat(0x3f800000u + i * 2654435761u % exponents); }
void main() {
  uint i = gl_GlobalInvocationID.x;
  float a = in_bits(i, 0x00800000u), b = in_bits(i * 7u + 5u, 0x01000000u);
  )" + statement + "\n}"),
                             threads * sizeof(float));
  std::get<Dispatch>(job.commands[0]).groups[0] = threads / 64;
  const Result<JobResult> result = backend("vulkan_loose").execute(job);
  EXPECT_TRUE(result) << (result ? "" : format(result.error()));
  if (!result) return std::vector<float>(threads);
  EXPECT_THAT(result->messages, testing::IsEmpty());
  return from_bytes<float>(result->read_backs[0]);
}

float in_bits(std::uint32_t i, std::uint32_t exponents) {
  return std::bit_cast<float>(0x3f800000U + i * 2654435761U % exponents);
}

/// The statement's result in exact arithmetic.
template <class Exact>
void expect_within(const std::string& statement, double allowed, const Exact& exact) {
  const std::vector<float> found = run_loose(statement);
  double worst = 0;
  for (std::uint32_t i = 0; i < found.size(); ++i) {
    const double right = exact(double{in_bits(i, 0x00800000U)}, double{in_bits(i * 7 + 5, 0x01000000U)});
    const auto nearest = static_cast<float>(right);
    const double ulp = std::nextafter(nearest, std::numeric_limits<float>::infinity()) - nearest;
    worst = std::max(worst, std::abs(found[i] - right) / ulp);
  }
  EXPECT_LE(worst, allowed) << statement;
  EXPECT_GT(worst, allowed - 0.6) << statement << ": a driver may do worse";
}

TEST(VulkanLoose, QuotientsAreUpToTwoAndAHalfUlpOff) {
  const auto quotient = [](double a, double b) { return a / b; };
  expect_within("result[i] = a / b;", 2.5, quotient);
  expect_within("result[i] = (vec2(3.0, a) / vec2(7.0, b)).y;", 2.5, quotient);
  expect_within("result[i] = (vec3(a, 1.0, b) / vec3(b, a, a)).x;", 2.5, quotient);
  expect_within("result[i] = (vec4(b, a, b, a) / vec4(a, b, a, b)).w;", 2.5, quotient);
}

TEST(VulkanLoose, RootsAreWhatReciprocalsOfInverseRootsMayBe) {
  expect_within("result[i] = sqrt(a);", 4.5, [](double a, double) { return std::sqrt(a); });
}

TEST(VulkanLoose, SumsAndProductsStayCorrectlyRounded) {
  const auto within_half = [](const std::string& statement, const auto& exact) {
    expect_within(statement, 0.5, exact);
  };
  within_half("result[i] = a * b;", [](double a, double b) { return a * b; });
  within_half("result[i] = a + b;", [](double a, double b) { return a + b; });
  within_half("result[i] = (a * vec2(b)).x;", [](double a, double b) { return a * b; });
}

TEST(VulkanLoose, WhatIsNotPreciseBecomesOneOperation) {
  const auto fused = [](const std::string& statement, double sign_of_product) {
    const std::vector<float> found = run_loose(statement);
    std::size_t contracted = 0;
    for (std::uint32_t i = 0; i < found.size(); ++i) {
      const float a = in_bits(i, 0x00800000U), b = in_bits(i * 7 + 5, 0x01000000U);
      const float rest = static_cast<float>(sign_of_product * (double{a} * b - static_cast<double>(a * b)));
      contracted += found[i] == rest && rest != 0;
    }
    return contracted;
  };
  // What is taken off is `a * b` as floats have it, by way of bits so that nothing can tell.
  const std::string rounded = "precise float p = a * b; float r = uintBitsToFloat(floatBitsToUint(p)); ";
  EXPECT_GT(fused(rounded + "result[i] = a * b - r;", 1), threads * 9 / 10);
  EXPECT_GT(fused(rounded + "result[i] = r - a * b;", -1), threads * 9 / 10);
  EXPECT_GT(fused(rounded + "result[i] = -r + a * b;", 1), threads * 9 / 10);
  EXPECT_EQ(fused(rounded + "precise float q = a * b - r; result[i] = q;", 1), 0U);
}

TEST(VulkanLoose, DenormalsAreZerosOfEitherSign) {
  bool positive = false, negative = false;
  for (const char* statement : {"result[i] = a * 1e-38 * 0.1;", "result[i] = b * 1e-38 - b * 1.01e-38;",
                                "result[i] = a * 0.0;", "result[i] = a * 1e-20 * 0.0;"}) {
    for (const float found : run_loose(statement)) {
      ASSERT_EQ(found, 0.0F) << statement;
      (std::signbit(found) ? negative : positive) = true;
    }
  }
  EXPECT_TRUE(positive && negative);
}

TEST(VulkanLoose, InfinityAndNanStayWhatTheyAre) {
  EXPECT_EQ(run_loose("result[i] = a / (b * 0.0);")[0] * 0 == 0, false);
  EXPECT_TRUE(std::isnan(run_loose("result[i] = sqrt(-a);")[0]));
}

TEST(VulkanLoose, TellsNoTimes) {
  EXPECT_FALSE(backend("vulkan_loose").info().features.contains("timestamps"));
}

}  // namespace
}  // namespace relievo::test
