#include "oracle/walk.hpp"

#include <cmath>

#include "oracle/axis_walk.hpp"
#include "oracle/clearance.hpp"
#include "oracle/segment.hpp"

namespace relievo::oracle {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Far above the rounding of a height computed either way (some 10⁻¹⁶), so that what is passed over cannot matter.
constexpr double rounding_margin = 1e-12;

/// A ray that has met the surface and is followed this far without sinking in by the ambiguity is near-tangent: a
/// plateau at the ray's own height may go on for ever.
constexpr int cells_followed_after_hit = 4096;

/// Counters are doubles, exact up to 2⁵³; a budget beyond this one could not be used up in a lifetime.
constexpr double largest_cell_budget = 1e15;

/// Where a walk stands: lines crossed along either axis, the cell, and when it was entered.
struct Cursor {
  double lines_x = 0, lines_y = 0;
  int cell_x = 0, cell_y = 0;
  double tau = 0;

  double cells_crossed() const { return lines_x + lines_y; }
};

class Walk {
 public:
  Walk(const Lattice& lattice, const MaxPyramid* pyramid, const OracleOptions& options, const Segment& segment)
      : lattice_(lattice),
        pyramid_(pyramid),
        segment_(segment),
        x_(make_axis_walk(lattice.x(), segment.x, segment.dx)),
        y_(make_axis_walk(lattice.y(), segment.y, segment.dy)),
        tau_per_height_(segment.dh < 0 ? -1 / segment.dh : 0),
        ambiguity_(options.ambiguity > 0 ? options.ambiguity : 0.0),
        budget_(std::min(static_cast<double>(options.max_cells), largest_cell_budget)) {
    cursor_.cell_x = x_.first_cell;
    cursor_.cell_y = y_.first_cell;
  }

  Hit find(const Ray& ray);

 private:
  struct Leave {
    double tau = 0;
    bool through_x = false;
  };

  /// The tie rule: a ray through a corner goes along x first. The cell in between is visited over a closed interval of
  /// length 0, and all four cells agree at the corner, so no hit is lost.
  Leave leave(double line_x, double line_y) const {
    const double at_x = x_.crossing(line_x), at_y = y_.crossing(line_y);
    return {std::min(at_x, at_y), at_x <= at_y};
  }
  void step(Cursor& cursor, const Leave& leave) const;
  double clear_until(double highest) const;
  bool pass_over_block(int level);
  bool visit_cell();
  Clearance clearance(const Cursor& cursor, const Corners& corners) const;
  bool is_near_tangent_hit(Cursor cursor, double s) const;
  void stop(HitStatus status, double tau) { status_ = status, stop_tau_ = tau; }
  int level_after(const Cursor& before, int level) const;

  const Lattice& lattice_;
  const MaxPyramid* pyramid_;
  const Segment& segment_;
  const AxisWalk x_, y_;
  const double tau_per_height_;
  const double ambiguity_, budget_;
  Cursor cursor_;
  bool ambiguous_ = false;
  HitStatus status_ = HitStatus::miss;
  double stop_tau_ = 0;
  std::uint32_t visited_ = 0;
};

void Walk::step(Cursor& cursor, const Leave& leave) const {
  cursor.tau = leave.tau;
  if (leave.through_x) {
    cursor.lines_x += 1;
    cursor.cell_x = x_.next(cursor.cell_x);
  } else {
    cursor.lines_y += 1;
    cursor.cell_y = y_.next(cursor.cell_y);
  }
}

/// After leaving a block of `level`, the next level to try: the parent's, when that is a new block too.
int Walk::level_after(const Cursor& before, int level) const {
  if (!pyramid_ || level >= pyramid_->top_level()) return level;
  const int shift = level + 1;
  const bool same_parent =
      before.cell_x >> shift == cursor_.cell_x >> shift && before.cell_y >> shift == cursor_.cell_y >> shift;
  return same_parent ? level : level + 1;
}

/// τ until which the ray is certain to stay clear of everything up to `highest`, given that it is where the cursor is.
double Walk::clear_until(double highest) const {
  const double needed = highest + ambiguity_ + rounding_margin;
  if (segment_.height(cursor_.tau) <= needed) return cursor_.tau;
  return segment_.dh < 0 ? (segment_.h - needed) * tau_per_height_ : infinity;
}

/// Passes over a block that stays below the ray, and returns true. Where the ray comes down into the block's heights,
/// goes only that far, and leaves the rest to the finer levels; so does a block in which the walk ends. Wherever the
/// cursor comes to stand, a walk by cells would have stood there too.
bool Walk::pass_over_block(int level) {
  const double clear = clear_until(pyramid_->max_over_block(level, cursor_.cell_x, cursor_.cell_y));
  if (clear <= cursor_.tau) return false;
  const double last_x = x_.last_line_of_block(level, cursor_.cell_x, cursor_.lines_x);
  const double last_y = y_.last_line_of_block(level, cursor_.cell_y, cursor_.lines_y);
  const Leave out = leave(last_x, last_y);
  const bool passes = clear > out.tau && out.tau < segment_.end;
  const double until = passes ? out.tau : std::min(clear, segment_.end);
  if (until == infinity) return false;
  // Of lines crossed at the same time, those along x come first: a passage through x precedes its equals along y.
  Cursor next = cursor_;
  next.lines_x = passes && out.through_x ? last_x : x_.lines_before(until, true, cursor_.lines_x, last_x);
  next.lines_y = passes && !out.through_x ? last_y : y_.lines_before(until, !passes, cursor_.lines_y, last_y);
  if (next.cells_crossed() + 1 >= budget_) return false;
  next.cell_x += x_.step * static_cast<int>(next.lines_x - cursor_.lines_x);
  next.cell_y += y_.step * static_cast<int>(next.lines_y - cursor_.lines_y);
  if (passes)
    step(next, out);
  else
    next.tau = std::max({cursor_.tau, x_.entry(next.lines_x), y_.entry(next.lines_y)});
  cursor_ = next;
  return passes;
}

Clearance Walk::clearance(const Cursor& at, const Corners& corners) const {
  return clearance_in_cell(corners, x_.local(at.lines_x, at.tau), y_.local(at.lines_y, at.tau), segment_.height(at.tau),
                           segment_.dx, segment_.dy, segment_.dh);
}

/// Solves one cell. Returns true when the search is over.
bool Walk::visit_cell() {
  const Leave out = leave(cursor_.lines_x, cursor_.lines_y);
  const bool last = out.tau >= segment_.end;
  // Without an end the ray is horizontal and the height constant along it: one point decides.
  const double end = !last ? out.tau : std::isinf(segment_.end) ? cursor_.tau : segment_.end;
  const double length = std::max(end - cursor_.tau, 0.0);
  const Corners corners = lattice_.corners(cursor_.cell_x, cursor_.cell_y);
  const double lowest = segment_.height(segment_.dh < 0 ? end : cursor_.tau);
  ++visited_;
  if (lowest <= corners.max() + ambiguity_ + rounding_margin) {
    const Clearance c = clearance(cursor_, corners);
    const double at_end =
        clearance_at(corners, x_.local(cursor_.lines_x, end), y_.local(cursor_.lines_y, end), segment_.height(end));
    std::optional<double> s = c.first_root(length, at_end);
    if (!s && last && segment_.at_end == HitStatus::hit) s = length;
    ambiguous_ = ambiguous_ || c.turns_away_within(ambiguity_, s.value_or(length));
    if (s) {
      const bool below = cursor_.tau == 0 && c.c0 < 0 && segment_.at_origin;
      stop(below ? HitStatus::inside : HitStatus::hit, cursor_.tau + *s);
      ambiguous_ = ambiguous_ || is_near_tangent_hit(cursor_, *s);
      return true;
    }
    if (last) ambiguous_ = ambiguous_ || at_end <= ambiguity_;
  }
  if (last) {
    stop(segment_.at_end, end);
    return true;
  }
  step(cursor_, out);
  return false;
}

/// A hit whose ray comes out again, or ends, before it has sunk in by the ambiguity could as well be a miss.
bool Walk::is_near_tangent_hit(Cursor at, double s) const {
  for (int i = 0; i < cells_followed_after_hit; ++i) {
    const Leave out = leave(at.lines_x, at.lines_y);
    const double end = std::min(out.tau, segment_.end);
    const double length = std::isinf(end) ? 0 : std::max(end - at.tau, 0.0);
    const Clearance c = clearance(at, lattice_.corners(at.cell_x, at.cell_y));
    s = std::min(s, length);
    switch (penetration({c.at(s), c.slope_at(s), c.c2}, length - s, ambiguity_)) {
      case Penetration::deepens:
        return false;
      case Penetration::comes_out:
        return true;
      case Penetration::undecided:
        break;
    }
    if (out.tau >= segment_.end) return segment_.at_end != HitStatus::hit;  // below the floor there is no way out
    step(at, out);
    s = 0;
  }
  return true;
}

Hit Walk::find(const Ray& ray) {
  int level = pyramid_ ? pyramid_->top_level() : 0;
  while (true) {
    if (cursor_.cells_crossed() >= budget_) {
      stop(HitStatus::exhausted, cursor_.tau);
      break;
    }
    const Cursor before = cursor_;
    if (level == 0 ? visit_cell() : !pass_over_block(level)) {
      if (level == 0) break;
      --level;
    } else {
      level = level_after(before, level);
    }
  }
  Hit hit = hit_at(segment_, ray, status_, stop_tau_);
  hit.ambiguous = ambiguous_;
  hit.steps = visited_;
  hit.fetches = visited_ < 0x40000000u ? 4 * visited_ : 0xffffffffu;
  return hit;
}

}  // namespace

Hit find_first_hit(const Lattice& lattice, const MaxPyramid* pyramid, const OracleOptions& options, const Ray& ray) {
  const auto prepared = make_segment(lattice, ray);
  if (const Hit* none = std::get_if<Hit>(&prepared)) return *none;
  return Walk(lattice, pyramid, options, std::get<Segment>(prepared)).find(ray);
}

}  // namespace relievo::oracle
