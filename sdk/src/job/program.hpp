/// What the makers of Jobs share: programs, and binding buffers and maps to a command.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "relievo/maps.hpp"
#include "relievo/trace.hpp"

namespace relievo {

/// Composes; values of owners that the permutation has not are dropped.
Result<ComposedProgram> compose_known(const Registry& registry, Permutation permutation);

/// Compiles a composed program for what a backend consumes.
Result<PreparedProgram> prepare_composed(ComposedProgram composed, std::string_view shader_target);

/// The programs of a job. Permutations that differ in uniform values alone share one: it is compiled once, by us and by
/// the driver.
class SharedPrograms {
 public:
  /// The program's index in the job, which it is added to if it is new.
  Result<int> index_of(const ComposedProgram& composed, std::string_view shader_target, Job& job);

 private:
  std::map<std::string, int> indices_;
};

Buffer make_buffer(std::string name, const void* data, std::size_t size);

/// Adds a buffer to the job and binds it; returns its index.
int bind_buffer(int set, int binding, Buffer buffer, Job& job, std::vector<ResourceBinding>& resources);

/// Every set of maps has the height map. Errors: "maps.missing".
Status check_height(const MapSet& maps);

/// Binds the program's maps; a map that the job has already (by name) is shared. Errors: "maps.missing".
Status bind_maps(const ComposedProgram& composed, const MapSet& maps, Job& job,
                 std::vector<ResourceBinding>& resources);

/// Binds the Parameters block (set 0, binding 0) if the program has one.
void bind_parameters(const ComposedProgram& composed, Job& job, std::vector<ResourceBinding>& resources);

/// Drops the bindings that the program's contract does not contain: resources of shaders that were optimised away.
void keep_contract(const ShaderProgram& program, std::vector<ResourceBinding>& resources);

/// Sets samplers to nearest where no program of the job samples their texture: not all devices can filter 32-bit
/// floats.
void keep_filters(Job& job);

void append_messages(const JobResult& result, std::vector<std::string>* messages);

}  // namespace relievo
