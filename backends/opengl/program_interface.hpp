/// A linked program's blocks, samplers and images against the binding contract.
#pragma once

#include <epoxy/gl.h>

#include "relievo/job.hpp"
#include "relievo/result.hpp"

namespace relievo::opengl {

/// Puts each named resource into its slot. A name that the driver optimised away is fine.
void assign_slots(const ShaderProgram& program, GLuint name);

/// Every resource that the linked program uses sits in a slot of the contract.
/// Error: "backend.binding-contract", naming the program, the resource and its slot.
Status check_contract(const ShaderProgram& program, GLuint name);

}  // namespace relievo::opengl
