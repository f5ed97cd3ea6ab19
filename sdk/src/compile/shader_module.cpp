#include "compile/shader_module.hpp"

#include <fmt/format.h>

#include <spirv_cross/spirv_parser.hpp>

namespace relievo {

tl::unexpected<Error> emit_error(std::string_view doing, std::string_view permutation_key, std::string_view reason) {
  return fail(ErrorCode::compile, "compile.emit",
              fmt::format("While {} permutation '{}': {}", doing, permutation_key, reason));
}

Result<ShaderModule> parse_module(ShaderStage stage, std::shared_ptr<const SpirvWords> spirv,
                                  std::string_view permutation_key) {
  return catch_emit_errors("reading", permutation_key, [&]() -> Result<ShaderModule> {
    ShaderModule module;
    module.stage = stage;
    spirv_cross::Parser parser(spirv->data(), spirv->size());
    parser.parse();
    module.ir = std::make_shared<const spirv_cross::ParsedIR>(std::move(parser.get_parsed_ir()));
    module.spirv = std::move(spirv);
    module.reflection = std::make_shared<const spirv_cross::CompilerReflection>(*module.ir);
    module.resources = module.reflection->get_shader_resources(module.reflection->get_active_interface_variables());
    return module;
  });
}

}  // namespace relievo
