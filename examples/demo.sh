#!/usr/bin/env bash
# Builds the `relievo` program and measures every technique on an asteroid and on real terrain: one page in build/demo.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$root"

bash tests/setup.sh
[ -f build/release/build.ninja ] || cmake --preset release >/dev/null
cmake --build build/release --target relievo_cli

# The images are small because the graphics drivers may be software; options of `relievo report` given here come last and win.
build/release/bin/relievo report \
  --scene examples/scenes/asteroid.toml --scene examples/scenes/jacksboro.toml \
  --height /usr/share/glmark2/textures/asteroid-height-map.png:0.1 \
  --height /usr/share/matplotlib/mpl-data/sample_data/jacksboro_fault_dem.npz:0.1 \
  --ray-image 256 --sweep-image 128 --repeats 2 -o build/demo "$@"
