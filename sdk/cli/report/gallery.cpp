/// Pictures: what every technique draws in every stage, beside what it should be.
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <map>

#include "report/html.hpp"
#include "report/page.hpp"
#include "report/picture_table.hpp"
#include "report/thumbnail.hpp"

namespace relievo::cli {

namespace {

using Rows = std::vector<const PictureRow*>;

struct Stage {
  std::string name;
  std::vector<std::string> techniques;   ///< in the order drawn; "" for a stage that traces nothing
  std::map<std::string, Rows> pictures;  ///< by technique, one a backend
};

/// The stages of a scene in the order drawn; those that displace the mesh itself, which others are held against, first.
std::vector<Stage> stages_of(const Evaluation& evaluation, const std::string& scene) {
  std::vector<Stage> stages;
  for (const PictureRow& p : evaluation.pictures) {
    if (p.scene != scene) continue;
    auto stage = std::find_if(stages.begin(), stages.end(), [&](const Stage& s) { return s.name == p.stage; });
    if (stage == stages.end()) stage = stages.insert(stages.end(), Stage{p.stage, {}, {}});
    Rows& rows = stage->pictures[p.technique];
    if (rows.empty()) stage->techniques.push_back(p.technique);
    rows.push_back(&p);
  }
  std::stable_partition(stages.begin(), stages.end(), [](const Stage& s) { return s.pictures.contains(""); });
  return stages;
}

std::vector<std::string> scenes_of(const Evaluation& evaluation) {
  std::vector<std::string> scenes;
  for (const PictureRow& p : evaluation.pictures) {
    if (std::find(scenes.begin(), scenes.end(), p.scene) == scenes.end()) scenes.push_back(p.scene);
  }
  return scenes;
}

const PictureAgreement* agreement(const Evaluation& evaluation, const PictureRow& p, bool with_backend) {
  for (const PictureAgreement& a : evaluation.picture_agreements) {
    bool same = a.scene == p.scene && a.stage == p.stage && a.technique == p.technique;
    if (same && is_backend(evaluation, a.right) == with_backend &&
        (a.left == p.backend || (with_backend && a.right == p.backend)))
      return &a;
  }
  return nullptr;
}

std::string reference_title(const std::string& reference) {
  return reference == "vertex" ? "the finely displaced mesh" : "the oracle";
}

std::string figures(const ImageDifference& d) {
  std::string psnr = std::isfinite(d.psnr) ? fixed(d.psnr, 1) + " dB" : "equal";
  return fmt::format("{} % within 1/255, largest {}/255, PSNR {}, mask IoU {}", fixed(d.within_percent, 2), d.largest,
                     psnr, fixed(d.mask_iou, 4));
}

/// One picture, small, leading to the file in the folder beside the page; `title` is bold, `text` follows.
Result<std::string> figure(const Report& report, const std::string& file, const std::string& title,
                           const std::string& text) {
  Result<std::string> uri = thumbnail_uri(report.pictures, file);
  if (!uri) return uri;
  return fmt::format(
      "<figure><a href=\"pictures/{}\"><img loading=\"lazy\" alt=\"{}\" src=\"{}\"></a><figcaption><b>{}</b> "
      "{}</figcaption></figure>\n",
      escape(file), escape(title), *uri, escape(title), escape(text));
}

/// Two backends' pictures are the same to the eye: one is shown.
constexpr double same_percent = 99.9;  // of pixels, within 1/255

bool shown(const Evaluation& evaluation, const PictureRow& p) {
  const PictureAgreement* between = agreement(evaluation, p, true);
  return !between || between->left == p.backend || between->difference.within_percent < same_percent;
}

std::string picture_text(const Evaluation& evaluation, const PictureRow& p) {
  std::string text = p.seconds >= 0 ? fixed(p.seconds * 1e3, 1) + " ms" : "";
  if (!p.repeatable) text += " changes from run to run";
  if (p.degenerate_triangles > 0) text += fmt::format(" {} triangles without area, drawn flat", p.degenerate_triangles);
  if (const PictureAgreement* between = agreement(evaluation, p, true)) {
    text += fmt::format("{}against {}: {}", text.empty() ? "" : "; ",
                        between->left == p.backend ? between->right : between->left, figures(between->difference));
  }
  return text;
}

/// A technique's pictures, one a backend where they differ, then their differences from the reference.
Result<std::string> technique_figures(const Report& report, const Rows& rows) {
  std::string html;
  for (const PictureRow* p : rows) {
    if (p->file.empty() || !shown(report.evaluation, *p)) continue;
    Result<std::string> item = figure(report, p->file, p->backend, picture_text(report.evaluation, *p));
    if (!item) return item;
    html += *item;
  }
  for (const PictureRow* p : rows) {
    const PictureAgreement* a = agreement(report.evaluation, *p, false);
    if (!a || p->difference_file.empty() || !shown(report.evaluation, *p)) continue;
    Result<std::string> item = figure(report, p->difference_file,
                                      fmt::format("{} − {}, ×8", p->backend, a->right == "vertex" ? "mesh" : a->right),
                                      figures(a->difference));
    if (!item) return item;
    html += *item;
  }
  return html;
}

std::string stage_note(const Report& report, const Stage& stage) {
  for (const auto& [technique, rows] : stage.pictures) {
    for (const PictureRow* p : rows) {
      if (const PictureAgreement* a = agreement(report.evaluation, *p, false)) {
        return fmt::format("The differences are from {}, eightfold.", reference_title(a->right));
      }
    }
  }
  return {};
}

Result<std::string> stage_html(const Report& report, const Stage& stage) {
  std::string note = stage_note(report, stage);
  std::string html = fmt::format("<h3>Stage {}</h3>\n", escape(stage.name));
  if (!note.empty()) html += fmt::format("<p class=\"soft\">{}</p>\n", escape(note));
  html += "<div class=\"pairs\">\n";
  for (const std::string& technique : stage.techniques) {
    Result<std::string> items = technique_figures(report, stage.pictures.at(technique));
    if (!items) return items;
    std::string title = technique.empty()       ? "displaces the mesh itself"
                        : technique == "oracle" ? "oracle: what it should be"
                                                : technique;
    html += fmt::format("<div class=\"pair\"><h4>{}</h4>\n<div class=\"pictures\">\n{}</div></div>\n", escape(title),
                        *items);
  }
  return html + "</div>\n";
}

}  // namespace

Result<std::string> gallery_section(const Report& report) {
  std::string html;
  for (const std::string& scene : scenes_of(report.evaluation)) {
    html += fmt::format("<section><h2>Pictures: {}</h2>\n{}", escape(scene), picture_table(report.evaluation, scene));
    for (const Stage& stage : stages_of(report.evaluation, scene)) {
      Result<std::string> part = stage_html(report, stage);
      if (!part) return part;
      html += *part;
    }
    html += "</section>\n";
  }
  return html;
}

}  // namespace relievo::cli
