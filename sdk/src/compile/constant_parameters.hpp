/// Makes parameters that a function only reads constant, as if their author had written `const in`.
#pragma once

namespace glslang {
class TIntermediate;
}

namespace relievo {

/// GLSL passes `in` parameters as copies that the callee may change, so glslang gives each argument a variable of its
/// own, whose loads and stores every later stage carries along and every emitted text shows (`vec3 param_1 = x;
/// f(param_1)`). Where no statement of the callee writes to a parameter, its value is passed as such. Arrays and
/// matrices are left as they are, since indexing a value by a variable needs one; so are samplers and blocks, which are
/// never copied. To be called between parsing and linking, by the thread that parsed.
void make_read_parameters_constant(glslang::TIntermediate& tree);

}  // namespace relievo
