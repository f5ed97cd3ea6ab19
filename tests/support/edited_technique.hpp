/// The files of a technique of a user, for tests that edit it.
#pragma once

#include <string>

namespace relievo::test {

/// "technique.toml".
inline std::string descriptor(const std::string& name, double bias = 0.25) {
  return "schema = 1\nname = \"" + name + "\"\ntitle = \"A technique to edit\"\nsource = \"none\"\n" +
         "summary = \"Moves by a bias.\"\nclass = \"non_iterative\"\nfirst_hit = \"never\"\nmodule = \"" + name +
         ".glsl\"\nmaps = [\"height\"]\nfeatures = [\"explicit_lod\"]\n\n[parameters.bias]\ntitle = \"Bias\"\n" +
         "unit = \"1\"\ntype = \"float\"\nmin = 0.0\nmax = 1.0\ndefault = " + std::to_string(bias) +
         "\nbinding = \"uniform\"\n";
}

/// "<name>.glsl".
inline std::string module(const std::string& name) {
  return "#include \"shaders/lib/interval.glsl\"\n#include \"part.glsl\"\n\nHit " + name + "_trace(Ray ray) {\n  " +
         "return relievo_hit_at(ray, RELIEVO_HIT, " + name + "_part() + " + name + "_bias);\n}\n";
}

/// "part.glsl", which the module includes; `value` is a GLSL expression.
inline std::string part(const std::string& name, const std::string& value) {
  return "float " + name + "_part() {\n  return " + value + ";\n}\n";
}

}  // namespace relievo::test
