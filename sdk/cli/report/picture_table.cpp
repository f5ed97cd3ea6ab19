#include "report/picture_table.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

#include "report/csv.hpp"
#include "report/html.hpp"

namespace relievo::cli {

namespace {

bool same_picture(const PictureAgreement& a, const PictureAgreement& b) {
  return a.scene == b.scene && a.stage == b.stage && a.technique == b.technique;
}

/// Two backends that draw the same to a step of 255 have one row.
bool repeats_another(const Evaluation& evaluation, const PictureAgreement& row) {
  return std::any_of(evaluation.picture_agreements.begin(), evaluation.picture_agreements.end(),
                     [&](const PictureAgreement& a) {
                       constexpr double same_percent = 99.9;
                       return same_picture(a, row) && a.right == row.left && is_backend(evaluation, a.left) &&
                              a.difference.within_percent >= same_percent;
                     });
}

std::string psnr_text(const ImageDifference& d) {
  return std::isfinite(d.psnr) ? fixed(d.psnr, 1) : "equal";
}

std::vector<Cell> cells(const PictureAgreement& a) {
  const PixelOffsets* o = a.offsets ? &*a.offsets : nullptr;
  return {{a.stage},
          {a.technique.empty() ? "displaces the mesh" : a.technique, "name"},
          {a.left},
          {psnr_text(a.difference)},
          {fixed(a.flip, 4)},
          {fixed(o ? o->pixels.p50 : -1, 3)},
          {fixed(o ? o->pixels.p99 : -1, 3)},
          {fixed(o ? o->lost_percent() : -1, 2)},
          {fixed(a.difference.mask_iou, 4)}};
}

}  // namespace

std::string picture_table(const Evaluation& evaluation, const std::string& scene) {
  std::vector<std::vector<Cell>> rows;
  for (const PictureAgreement& a : evaluation.picture_agreements) {
    if (a.scene == scene && a.right == "oracle" && !repeats_another(evaluation, a)) rows.push_back(cells(a));
  }
  if (rows.empty()) return {};
  return "<p>Against the oracle's picture. FLIP is what an eye sees that flips between the two, 0 to 1, at 67 pixels a "
         "degree, the mean; its maps are in pictures/*-flip.png. The offset is how many pixels away the oracle's "
         "picture shows what a pixel shows; lost is what it shows nowhere. A hit behind something that hides it counts "
         "from the edge. IoU: of the pixels drawn.</p>\n" +
         table({{"stage"},
                {"technique"},
                {"backend"},
                {"PSNR dB", true},
                {"FLIP", true},
                {"offset px p50", true},
                {"p99", true},
                {"lost %", true},
                {"IoU", true}},
               rows);
}

std::string pictures_csv(const Evaluation& evaluation) {
  std::string text = "scene,stage,technique,backend,psnr,flip,offset_p50,offset_p99,offset_max,lost_percent,mask_iou\n";
  for (const PictureAgreement& a : evaluation.picture_agreements) {
    if (a.right != "oracle") continue;
    text += fmt::format("{},{},{},{},{:.6g},{}", csv_field(a.scene), a.stage, csv_field(a.technique), a.left,
                        a.difference.psnr, csv_number(a.flip));
    text += a.offsets
                ? fmt::format(",{},{},{},{}", csv_number(a.offsets->pixels.p50), csv_number(a.offsets->pixels.p99),
                              csv_number(a.offsets->pixels.max), csv_number(a.offsets->lost_percent()))
                : ",,,,";
    text += fmt::format(",{:.6g}\n", a.difference.mask_iou);
  }
  return text;
}

}  // namespace relievo::cli
