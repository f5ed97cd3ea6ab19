// The vertex layout of every drawing stage; the twin in C++ is MeshVertex (job/mesh_buffers.cpp).
layout(location = 0) in vec3 in_position;
layout(location = 1) in vec3 in_extrusion;  // displacement of height 1: welded, so that neighbours agree
layout(location = 2) in vec2 in_uv;
layout(location = 3) in vec3 in_tangent;    // survey Eq. 5, of the triangle: true Jacobian, zero where degenerate
layout(location = 4) in vec3 in_bitangent;
layout(location = 5) in uint in_weld;       // equal for equal positions: orders the corners of a prism
