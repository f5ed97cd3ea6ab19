#include <cmath>

#include "evaluation/evaluation.hpp"

namespace relievo::cli {

namespace {

nlohmann::json difference_json(const ImageDifference& d) {
  nlohmann::json json = {{"within_percent", d.within_percent}, {"largest", d.largest}, {"mask_iou", d.mask_iou}};
  if (std::isfinite(d.psnr)) json["psnr"] = d.psnr;  // infinite for equal pictures: left out
  return json;
}

nlohmann::json agreement_json(const PictureAgreement& p) {
  nlohmann::json json = {{"scene", p.scene}, {"stage", p.stage}, {"technique", p.technique},
                         {"left", p.left},   {"right", p.right}, {"difference", difference_json(p.difference)}};
  if (p.flip >= 0) json["flip"] = p.flip;
  if (p.offsets) {
    json["pixel_offset"] = {{"judged", p.offsets->judged},
                            {"lost", p.offsets->lost},
                            {"p50", p.offsets->pixels.p50},
                            {"p99", p.offsets->pixels.p99},
                            {"max", p.offsets->pixels.max}};
  }
  return json;
}

template <class Rows, class Convert>
nlohmann::json list(const Rows& rows, Convert convert) {
  nlohmann::json json = nlohmann::json::array();
  for (const auto& row : rows) json.push_back(convert(row));
  return json;
}

}  // namespace

nlohmann::json to_json(const Evaluation& e) {
  using json = nlohmann::json;
  json result;
  result["schema"] = 1;
  result["backends"] = list(e.backends, [](const EvaluatedBackend& b) {
    return json{{"name", b.info.name},
                {"title", b.info.title},
                {"device", b.info.device},
                {"driver", b.info.driver},
                {"api_version", b.info.api_version},
                {"own_values", b.own_values}};
  });
  result["rays"] = list(e.rays, [](const RayRow& r) {
    json row = to_json(r.error);
    row.update({{"case", r.case_name},
                {"technique", r.technique},
                {"backend", r.backend},
                {"filter", r.filter},
                {"angle", r.angle},
                {"steps", r.error.mean_steps},
                {"fetches", r.error.mean_fetches}});
    if (r.seconds >= 0) row["seconds"] = r.seconds;
    return row;
  });
  result["ray_agreements"] = list(e.ray_agreements, [](const RayAgreement& r) {
    return json{{"case", r.case_name}, {"technique", r.technique}, {"filter", r.filter},
                {"angle", r.angle},    {"judged", r.judged},       {"equal_percent", r.equal_percent}};
  });
  result["pictures"] = list(e.pictures, [](const PictureRow& p) {
    json row = {{"scene", p.scene},
                {"stage", p.stage},
                {"technique", p.technique},
                {"backend", p.backend},
                {"file", p.file},
                {"difference_file", p.difference_file},
                {"flip_file", p.flip_file},
                {"repeatable", p.repeatable},
                {"degenerate_triangles", p.degenerate_triangles}};
    if (p.seconds >= 0) row["seconds"] = p.seconds;
    return row;
  });
  result["picture_agreements"] = list(e.picture_agreements, agreement_json);
  result["cracks"] = list(e.cracks, [](const CrackRow& c) {
    return json{
        {"scene", c.scene}, {"technique", c.technique}, {"backend", c.backend}, {"seed", c.seed}, {"cracks", c.cracks}};
  });
  result["messages"] = e.messages;
  result["checks"] = list(e.checks, [](const Check& c) {
    return json{{"name", c.name}, {"found", c.found}, {"expected", c.expected}, {"passed", c.passed}};
  });
  result["not_run"] = list(e.not_run, [](const NotRun& n) { return json{{"what", n.what}, {"reason", n.reason}}; });
  return result;
}

}  // namespace relievo::cli
