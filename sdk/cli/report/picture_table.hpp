/// How far every picture is from the oracle's, in figures.
#pragma once

#include <string>

#include "evaluation/evaluation.hpp"

namespace relievo::cli {

/// The table of one scene: of backends whose pictures are the same, the first. Empty without an oracle's picture.
std::string picture_table(const Evaluation& evaluation, const std::string& scene);

/// The same for all scenes and backends, RFC 4180: scene, stage, technique, backend, PSNR (dB, "inf" when equal), FLIP,
/// pixel offsets (empty where they were not measured), IoU of the masks.
std::string pictures_csv(const Evaluation& evaluation);

}  // namespace relievo::cli
