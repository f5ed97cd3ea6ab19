// The exact first hit of a ray with one bilinear cell.

// Smallest s in [0, 1] where a + b s + c s² <= 0, or 2 if there is none. No cancellation: the root is computed from the
// half that adds equal signs. Linear, constant and tangent cases fall out of it.
float relievo_first_root(float a, float b, float c) {
  if (a <= 0.0) return 0.0;
  precise float discriminant = b * b - 4.0 * a * c;
  if (discriminant < 0.0) return 2.0;
  float root = sqrt(discriminant);
  if (b < 0.0) {
    precise float q = 0.5 * (root - b);
    return q > 0.0 && a <= q ? a / q : 2.0;
  }
  // What rises at first comes down to 0 within [0, 1] only if c outweighs a. A discriminant that underflows cannot tell.
  if (!(a <= -c)) return 2.0;
  precise float q = -0.5 * (b + root);
  float s = q / c;
  return s <= 1.0 ? s : 2.0;
}

// H − h at a point of the cell.
float relievo_cell_clearance(vec4 corners, vec3 point) {
  precise float du = corners.y - corners.x;
  precise float dv = corners.z - corners.x;
  precise float twist = (corners.w - corners.z) - du;
  precise float height = corners.x + du * point.x + (dv + twist * point.x) * point.y;
  precise float clearance = point.z - height;
  return clearance;
}

// Corners (00, 10, 01, 11) of a cell; the ray runs from `from` to `to` (position within the cell in [0, 1]², height H).
// Returns the share of the way to the first point that is not above the surface, or 2.
float relievo_cell_hit(vec4 corners, vec3 from, vec3 to) {
  precise float du = corners.y - corners.x;
  precise float dv = corners.z - corners.x;
  precise float twist = (corners.w - corners.z) - du;
  precise vec3 way = to - from;
  precise float height = corners.x + du * from.x + (dv + twist * from.x) * from.y;
  precise float a = from.z - height;
  precise float b = way.z - (du * way.x + dv * way.y + twist * (from.x * way.y + from.y * way.x));
  precise float c = -twist * way.x * way.y;
  return relievo_first_root(a, b, c);
}
