#!/usr/bin/env bash
# Builds the `relievo` program and measures every technique on an asteroid and on real terrain: one page in build/demo.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$root"

bash tests/setup.sh
[ -f build/release/build.ninja ] || cmake --preset release >/dev/null
cmake --build build/release --target relievo_cli

# A quick look of a minute, of one and a half where drivers compile the shaders first; `--full` given here measures
# everything in about a quarter of an hour. Options of `relievo report` given here come last and win. Height maps that are
# not installed are left out.
irrlicht=/usr/share/doc/libirrlicht-dev/media
build/release/bin/relievo report --quick \
  --scene examples/scenes/asteroid.toml --scene examples/scenes/jacksboro.toml \
  --height /usr/share/glmark2/textures/asteroid-height-map.png:0.1 \
  --height /usr/share/matplotlib/mpl-data/sample_data/jacksboro_fault_dem.npz:0.1 \
  --height /usr/share/doc/povray/examples/advanced/crater/crater_dat.png:0.1 \
  --height "$irrlicht/terrain-heightmap.bmp.gz:0.1" --height "$irrlicht/rockwall_height.bmp.gz:0.1" \
  -o build/demo "$@"
