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

/// The statement's result is `exact` to `allowed` ulp, given the exact one, and no driver need be worse than that.
template <class Exact, class Allowed>
void expect_within(const std::string& statement, const Allowed& allowed, const Exact& exact) {
  const std::vector<float> found = run_loose(statement);
  double worst = 0;  // of what is allowed
  for (std::uint32_t i = 0; i < found.size(); ++i) {
    const double right = exact(double{in_bits(i, 0x00800000U)}, double{in_bits(i * 7 + 5, 0x01000000U)});
    const auto nearest = static_cast<float>(right);
    const double ulp = std::nextafter(nearest, std::numeric_limits<float>::infinity()) - nearest;
    worst = std::max(worst, std::abs(found[i] - right) / ulp / allowed(right));
  }
  EXPECT_LE(worst, 1) << statement;
  EXPECT_GT(worst, 0.9) << statement << ": a driver may do worse";
}

/// The same anywhere.
auto ulp(double count) {
  return [=](double) { return count; };
}

TEST(VulkanLoose, QuotientsAreUpToTwoAndAHalfUlpOff) {
  const auto quotient = [](double a, double b) { return a / b; };
  for (const char* statement :
       {"result[i] = a / b;", "result[i] = (vec2(3.0, a) / vec2(7.0, b)).y;",
        "result[i] = (vec3(a, 1.0, b) / vec3(b, a, a)).x;", "result[i] = (vec4(b, a, b, a) / vec4(a, b, a, b)).w;"})
    expect_within(statement, ulp(2.5), quotient);
}

TEST(VulkanLoose, RootsAreWhatReciprocalsOfInverseRootsMayBe) {
  const auto allowed = [](double root) { return root < std::sqrt(2) ? 3.5 : 4.5; };
  expect_within("result[i] = sqrt(a);", allowed, [](double a, double) { return std::sqrt(a); });
  expect_within("result[i] = sqrt(b);", allowed, [](double, double b) { return std::sqrt(b); });
  expect_within("result[i] = sqrt(max(b, 2.0));", ulp(4.5),
                [](double, double b) { return std::sqrt(std::max(b, 2.)); });
}

TEST(VulkanLoose, SumsAndProductsStayCorrectlyRounded) {
  const auto within_half = [](const std::string& statement, const auto& exact) {
    expect_within(statement, ulp(0.5), exact);
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
  EXPECT_GT(fused(rounded + "result[i] = r + -(a * b);", -1), threads * 9 / 10);
  EXPECT_GT(fused(rounded + "result[i] = (vec2(b, a) * b - vec2(r)).y;", 1), threads * 9 / 10);
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

TEST(VulkanLoose, InfinityAndNanStayWhatTheyAreAndNothingBecomesThem) {
  for (const float found : run_loose("result[i] = a / (b * 0.0);")) EXPECT_TRUE(std::isinf(found)) << found;
  for (const float found : run_loose("result[i] = sqrt(-a);")) EXPECT_TRUE(std::isnan(found)) << found;
  const std::string greatest = "uintBitsToFloat(0x7f7fffffu - (i & 1u))";
  for (const float found : run_loose("result[i] = " + greatest + " / (a < 1.0 ? 2.0 : 1.0);")) {
    EXPECT_GT(found, 3e38F);
    EXPECT_TRUE(std::isfinite(found)) << found;
  }
}

TEST(VulkanLoose, QuotientsByWhatIsTooGreatAreLost) {
  for (const float found : run_loose("result[i] = a / (a * 1e38);")) EXPECT_EQ(found, 0);
}

TEST(VulkanLoose, LeavesWhatIsNotValidToTheDriver) {
  for (const std::size_t kept : {std::size_t{3}, std::size_t{5}, std::size_t{40}}) {
    Job job = make_compute_job(make_compute("cut",
                                            "layout(local_size_x = 1) in;\nlayout(std430, set = 0, binding = 0) "
                                            "buffer Result { float result[]; };\nvoid main() {}"),
                               4);
    job.programs[0].shaders[0].spirv.resize(kept);
    const Result<JobResult> result = backend("vulkan_loose").execute(job);
    ASSERT_FALSE(result) << kept;
    EXPECT_EQ(result.error().id, "backend.spirv") << kept;
  }
}

TEST(VulkanLoose, TellsNoTimes) {
  EXPECT_FALSE(backend("vulkan_loose").info().features.contains("timestamps"));
}

}  // namespace
}  // namespace relievo::test
