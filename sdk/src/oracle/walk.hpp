/// The search for the first hit, cell by cell.
#pragma once

#include "oracle/lattice.hpp"
#include "oracle/max_pyramid.hpp"
#include "relievo/oracle.hpp"

namespace relievo::oracle {

/// First hit of one ray; the contract is that of Oracle::trace. With a pyramid the walk passes over blocks that stay
/// more than the ambiguity below the ray; without one (null) it visits every cell. Both give the same status, t, u, v,
/// h and ambiguity, bit for bit; only steps and fetches differ.
Hit find_first_hit(const Lattice& lattice, const MaxPyramid* pyramid, const OracleOptions& options, const Ray& ray);

}  // namespace relievo::oracle
