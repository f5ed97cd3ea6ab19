#!/usr/bin/env bash
# What `relievo permute` costs on examples/permutations, beside the packaged tools one process after the other.
# Prints a table; everything is measured in this one run. Takes about three minutes on 2 cores.
#   bash tests/benchmarks/permute.sh [SAMPLE]     SAMPLE: permutations that the packaged tools compile (default 50)
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
relievo=$root/build/release/bin/relievo
manifest=$root/examples/permutations/relievo.toml
sample=${1:-50}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# measure NAME COMMAND…: wall seconds, CPU seconds and peak MiB of the command, into $work/NAME.*
measure() {
  local name=$1
  shift
  /usr/bin/env time -f '%e %U %S %M' -o "$work/$name.time" "$@" >"$work/$name.out" 2>&1 || { cat "$work/$name.out"; exit 1; }
  read -r wall user system peak <"$work/$name.time"
  printf '%-34s %8.2f s wall %8.2f s CPU %6d MiB\n' "$name" "$wall" "$(compute "$user + $system")" $((peak / 1024))
}
wall_of() { cut -d' ' -f1 "$work/$1.time"; }
compute() { awk "BEGIN { print $1 }"; }

cores=$(nproc)
measure cold_$cores "$relievo" permute "$manifest" -o "$work/cold" -j "$cores" --cache "$work/cache"
measure warm "$relievo" permute "$manifest" -o "$work/warm" -j "$cores" --cache "$work/cache"
measure unchanged "$relievo" permute "$manifest" -o "$work/warm" -j "$cores" --cache "$work/cache"
measure cold_1 "$relievo" permute "$manifest" -o "$work/one" -j 1 --no-cache
measure cold_${cores}_no_cache "$relievo" permute "$manifest" -o "$work/two" -j "$cores" --no-cache
cmp "$work/cold/cliffs.rla" "$work/warm/cliffs.rla"
cmp "$work/cold/cliffs.rla" "$work/one/cliffs.rla"
cmp "$work/cold/cliffs.rla" "$work/two/cliffs.rla"
grep asked "$work/cold_$cores.out"

# The same permutations by the packaged tools: for each shader glslangValidator, spirv-opt and four of spirv-cross.
"$relievo" permute "$manifest" --sources "$work/sources" --sample "$sample" >/dev/null
six_processes() {
  for folder in "$work"/sources/*/; do
    for shader in "$folder"*; do
      glslangValidator -V --target-env vulkan1.0 "$shader" -o "$work/a.spv" >/dev/null
      spirv-opt -O "$work/a.spv" -o "$work/b.spv"
      spirv-cross "$work/b.spv" --version 450 --no-es --output "$work/x.glsl"
      case $shader in *.geom) continue ;; esac # the others have no geometry shaders
      [ -e "$folder"*.geom ] && continue
      spirv-cross "$work/b.spv" --version 300 --es --output "$work/x.es"
      spirv-cross "$work/b.spv" --hlsl --shader-model 50 --output "$work/x.hlsl"
      spirv-cross "$work/b.spv" --msl --msl-version 20200 --output "$work/x.msl"
    done
  done
}
export -f six_processes
export work
measure six_processes bash -euo pipefail -c six_processes

programs=$(sed -n 's/.* \([0-9]*\) programs.*/\1/p' "$work/cold_$cores.out")
compiled=$(find "$work/sources" -mindepth 1 -maxdepth 1 -type d | wc -l)
ours=$(compute "1000 * $(wall_of cold_${cores}_no_cache) / $programs")
theirs=$(compute "1000 * $(wall_of six_processes) / $compiled")
printf 'a unique permutation: %.1f ms here, %.1f ms by the packaged tools (%d of them): %.1f times faster\n' \
  "$ours" "$theirs" "$compiled" "$(compute "$theirs / $ours")"
printf '%d threads over one: %.2f times faster\n' "$cores" \
  "$(compute "$(wall_of cold_1) / $(wall_of cold_${cores}_no_cache)")"
