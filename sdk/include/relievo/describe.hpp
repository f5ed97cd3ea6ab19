/// Descriptors: what techniques, maps and stages say of themselves, and the registry that finds them by scanning.
/// The schema of the three files is in docs/descriptors.md.
/// Every function and member function here is thread-safe; many threads may read one registry.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "relievo/job.hpp"
#include "relievo/result.hpp"

namespace relievo {

/// When a loop count or parameter gets its value: as a macro (re-parse), a specialization constant (no re-parse), or a
/// uniform (no new program).
enum class BindingTime { macro, specialization, uniform };
std::string_view to_string(BindingTime time);

/// Shader-model features a descriptor can require.
/// dynamic_loops, explicit_lod, texture_3d, gather, geometry, tessellation, compute, vertex_texture, depth_write,
/// extended_images
using FeatureSet = std::set<std::string>;
const FeatureSet& known_features();

/// What one axis of a permutation is, or may be: "filter" is "exact"; "maps" has "normal" and "cone".
struct Condition {
  /// technique, stage, address, filter, aov, count, target, a parameter ("relief.linear_steps"); or maps, features.
  std::string subject;
  std::vector<std::string> words;
};

/// When every condition of `when` holds (the subject is one of its words), then `then` must: a subject with one value
/// is one of its words, `maps` and `features` have them all. With `excludes`, it is, or has, none of them. What a
/// permutation does not have, such as a parameter of a technique that is not bound, is never broken.
struct Rule {
  std::vector<Condition> when;
  Condition then;
  bool excludes = false;
  std::string reason;  ///< the author's sentence; may be empty
  std::string file;
  int line = 0;
};
/// "surface.normal_source = height requires filter = exact".
std::string to_string(const Rule& rule);

/// What holds of a permutation, by subject; rules about a subject that is absent do not apply.
using Facts = std::map<std::string, std::set<std::string>, std::less<>>;
bool is_broken(const Rule& rule, const Facts& facts);

/// A loop count or parameter. In GLSL it is the identifier `<owner>_<name>`. An axis is a parameter whose values have
/// names: `value` is the index of one, and `<owner>_<name>_<value>` is that index in GLSL.
struct Parameter {
  std::string name;
  std::string title;
  bool is_integer = false;
  bool is_loop = false;                        ///< an iteration bound
  std::string unit;                            ///< "steps", "texels", "1", …
  double minimum = 0, maximum = 0, value = 0;  ///< range and default
  BindingTime binding = BindingTime::uniform;
  std::vector<BindingTime> bindings;           ///< those that a caller may choose; empty: all
  std::vector<std::string> choices;            ///< an axis: the names of its values
  std::vector<std::vector<std::string>> maps;  ///< an axis: the maps that each value needs beside the owner's
  std::vector<FeatureSet> features;            ///< an axis: the features that each value needs
  std::vector<Rule> rules;                     ///< an axis: what its values require and exclude
  std::optional<double> software_value;        ///< an axis: the same results sooner on drivers that use the CPU
  std::string file;
  int line = 0;  ///< where it was declared
};

/// A parameter's value from its text: a number, or the name of a choice. Errors: "describe.value" with what is
/// expected.
Result<double> parse_value(const Parameter& parameter, std::string_view text);
/// The reverse: the name of the choice, or the number, shortest form.
std::string value_text(const Parameter& parameter, double value);

/// The survey's classes (§4): does it guarantee the first hit? `reference` is ours: not an algorithm but what others
/// are judged by; sweeps over all techniques leave it out.
enum class TechniqueClass { non_iterative, unsafe, quasi_safe, safe, combined, reference };
std::string_view to_string(TechniqueClass value);

/// What a technique promises of the first hit, weakest first; a manifest's scene prunes what promises less.
/// `always` alone is a guarantee: `conform`, hard cases and fuzzing hold a technique to it. `if_steps_under_texel`:
/// likely where steps stay under a texel, never certain, for a ray that grazes the surface enters and leaves it within
/// as little as one likes. `never`: nothing.
enum class FirstHit { never, if_steps_under_texel, always };
std::string_view to_string(FirstHit value);

struct TechniqueDescriptor {
  std::string name, title, source, summary;
  TechniqueClass technique_class = TechniqueClass::unsafe;
  FirstHit first_hit = FirstHit::never;
  std::vector<std::string> maps;      ///< names of the maps it reads, "height" included
  std::vector<Parameter> parameters;  ///< loops first, then the others
  FeatureSet features;
  std::string module;  ///< source path of its GLSL in the registry's tree
  std::string file;    ///< source path of the descriptor
};

/// `single`: as large as the height map. `pyramid`: the next powers of two, with every level down to 1×1; level k is
/// baked from level k − 1. `coarse_pyramid`: the same without its two finest levels, so a texel of level 0 is for
/// 4 × 4.
enum class MapLevels { single, pyramid, coarse_pyramid };
std::string_view to_string(MapLevels levels);

/// sampler2D, sampler2DArray, sampler3D. The last two have `single` levels only.
enum class MapDimension { flat, array, volume };
std::string_view to_string(MapDimension dimension);

/// Which way a quantised value may move, so that what a technique concludes from it stays true. `exact`: not
/// at all; the map takes as many bits as that needs.
enum class Rounding { nearest, up, down, exact };
std::string_view to_string(Rounding rounding);

/// A map baked by a compute module: reads its inputs, writes `channels` floats a texel.
struct MapDescriptor {
  std::string name, title, source, summary;
  std::vector<std::string> inputs;  ///< other maps; empty for `height`, which the caller provides
  int channels = 1;                 ///< 1–4
  MapLevels levels = MapLevels::single;
  MapDimension dimension = MapDimension::flat;
  int layers = 1;                ///< of an array, or texels along the third axis; or
  std::string layers_parameter;  ///< the int parameter that says how many; empty = `layers`
  /// Times that the module runs over every level, by phase; later passes read what earlier ones wrote. Each phase is a
  /// program of its own, which knows its number (RELIEVO_BAKE_PHASE).
  std::vector<int> passes = {1};
  /// Address modes with which the passes of a layer read no other layer; where there is one pass, all.
  std::vector<std::string> layers_apart;
  int layers_at_once = 1;  ///< that one run of the module writes (RELIEVO_BAKE_LAYERS_AT_ONCE)
  /// One a channel, for maps that have an int parameter `bits` (8, 16 or 32): 8 and 16 are stored as unorm. Empty:
  /// floats.
  std::vector<Rounding> rounding;
  bool is_uint = false;  ///< shaders read whole numbers k, with a usampler, and not k / (2^bits − 1)
  std::string sampler;   ///< GLSL name, e.g. "relievo_height_map"
  /// GLSL format, e.g. "rgba8", of maps that can be read as an image: they have an axis `fetch` with the value
  /// `image`.
  std::string image;
  int set = 1, binding = 0;  ///< the binding contract; unique among maps
  std::vector<Parameter> parameters;
  FeatureSet features;
  std::string module;  ///< compute shader; empty for provided maps
  std::string access;  ///< GLSL included wherever the map is bound: its sampling functions; may be empty
  std::string file;
};

struct StageShader {
  ShaderStage stage = ShaderStage::compute;
  std::string module;
};

/// A stage hosts a technique's trace (roles non-empty) or displaces geometry itself (roles empty).
struct StageDescriptor {
  std::string name, title, source, summary;
  std::vector<StageShader> shaders;  ///< in pipeline order
  std::vector<std::string> roles;    ///< "view", …
  std::vector<std::string> maps;     ///< maps the stage itself reads, e.g. "normal" for shading
  std::vector<Parameter> parameters;
  FeatureSet features;
  std::string fallback;           ///< the stage to use where a feature is missing; may be empty
  std::string mesh;               ///< what geometry it draws: "none" (compute), "base", "tessellated", "prisms"
  bool hits_within_tile = false;  ///< u and v of hits may lack whole tiles (docs/descriptors.md says how to add them)
  std::string file;
};

/// Every file of the SDK and of the user's folders by source path ("shaders/lib/ray.glsl"): what the composer may
/// include.
using SourceTree = std::map<std::string, std::string, std::less<>>;

struct Registry {
  std::map<std::string, TechniqueDescriptor, std::less<>> techniques;
  std::map<std::string, MapDescriptor, std::less<>> maps;
  std::map<std::string, StageDescriptor, std::less<>> stages;
  SourceTree sources;
  /// Where the sources that came from a user's folder lie on disk, by source path: what diagnostics should name.
  std::map<std::string, std::string, std::less<>> origins;

  /// Look-ups by name; the error ("describe.unknown-technique", …) names the nearest known name.
  Result<const TechniqueDescriptor*> technique(std::string_view name) const;
  Result<const MapDescriptor*> map(std::string_view name) const;
  Result<const StageDescriptor*> stage(std::string_view name) const;
};

/// The files embedded in the library at build time.
const SourceTree& embedded_sources();

/// Our own descriptors, and those in each of `folders`: every subfolder (or the folder itself) that holds a
/// technique.toml, map.toml or stage.toml; its files enter the tree below "<subfolder kind>/<subfolder name>/".
/// A name that is already taken is an error ("describe.duplicate").
Result<Registry> load_registry(const std::vector<std::filesystem::path>& folders = {});

/// Folders in braces, `load_registry({a, b})`, which would otherwise be a tree as well.
inline Result<Registry> load_registry(std::initializer_list<std::filesystem::path> folders) {
  return load_registry(std::vector<std::filesystem::path>(folders));
}

/// As above from a tree alone; what the embedded sources go through.
Result<Registry> load_registry(SourceTree sources);

/// Parses one descriptor. `path` is its source path; relative module paths resolve against its folder.
/// Errors carry line and column, the given value, what was expected, and the nearest known key.
Result<TechniqueDescriptor> parse_technique(std::string_view text, const std::string& path);
Result<MapDescriptor> parse_map(std::string_view text, const std::string& path);
Result<StageDescriptor> parse_stage(std::string_view text, const std::string& path);

/// The candidate nearest to `name` by edit distance, or empty when none is near (distance > max(2, length/3)).
std::string nearest_name(std::string_view name, const std::vector<std::string>& candidates);

}  // namespace relievo
