/* Relievo for C and for whatever can call C: techniques, programs, archives, maps and rays (docs/c-api.md).
 *
 * Every function but the `_free` ones and the versions returns a status and takes a `relievo_error*`, which may be
 * NULL; the error is the caller's own, so nothing is kept by thread. A status that is not RELIEVO_OK leaves the results
 * as they were, unless a function says otherwise. NULL where something is expected, a number that is none of an
 * enumeration, and an index out of range are errors. Nothing throws. A lack of memory is a status of the functions on
 * archives; while descriptors are read and shaders compiled, libraries inside may end the program on it.
 *
 * Handles are made by one function and freed by another, which takes NULL. All but reloaders are immutable, so that any
 * number of threads may read one at once; only freeing must wait for the others. What differs is said at the function.
 *
 * Views (relievo_string, relievo_bytes) live as long as the handle that they come from. Names are UTF-8. */
#ifndef RELIEVO_H
#define RELIEVO_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Common. */

typedef int32_t relievo_status;
enum {
  RELIEVO_OK = 0,
  RELIEVO_ERROR_USAGE = 1,       /* a wrong argument */
  RELIEVO_ERROR_IO = 2,          /* a file that cannot be read, understood or written */
  RELIEVO_ERROR_DESCRIPTOR = 3,  /* a technique.toml, map.toml, stage.toml or manifest that does not validate */
  RELIEVO_ERROR_COMPILE = 4,     /* composing or compiling a shader failed */
  RELIEVO_ERROR_UNSUPPORTED = 5, /* the target, backend or driver cannot do it */
  RELIEVO_ERROR_MISMATCH = 6,    /* results disagree */
  RELIEVO_ERROR_BACKEND = 7,     /* a graphics API call failed */
  RELIEVO_ERROR_MEMORY = 8,      /* there is not enough memory */
  RELIEVO_ERROR_INTERNAL = 9     /* a fault of ours */
};

/* What went wrong; of RELIEVO_OK the texts are empty and the numbers 0. Texts that are too long are cut at a character
 * and end in "...". */
typedef struct relievo_error {
  relievo_status code;
  int32_t line, column; /* 1-based; 0 = unknown */
  char id[64];          /* stable: "describe.unknown-key", "archive.missing" */
  char message[4096];   /* one sentence with the given and the expected value */
  char file[1024];      /* the author's, or empty */
} relievo_error;

/* `size` bytes; a zero follows, which is not counted. */
typedef struct relievo_string {
  const char* data;
  size_t size;
} relievo_string;

/* Of SPIR-V: words in the byte order of the machine for programs, little-endian in archives; aligned to 4. */
typedef struct relievo_bytes {
  const void* data;
  size_t size;
} relievo_bytes;

/* "0.1.0"; lives for ever. Thread-safe. */
relievo_string relievo_version(void);
/* Changes whenever compiled programs may. Lives for ever. Thread-safe. */
relievo_string relievo_compiler_version(void);

typedef int32_t relievo_kind;
enum { RELIEVO_TECHNIQUE = 0, RELIEVO_STAGE = 1, RELIEVO_MAP = 2 };

typedef int32_t relievo_shader_stage;
enum {
  RELIEVO_VERTEX = 0,
  RELIEVO_TESSELLATION_CONTROL = 1,
  RELIEVO_TESSELLATION_EVALUATION = 2,
  RELIEVO_GEOMETRY = 3,
  RELIEVO_FRAGMENT = 4,
  RELIEVO_COMPUTE = 5
};

typedef int32_t relievo_binding_time;
enum { RELIEVO_MACRO = 0, RELIEVO_SPECIALIZATION = 1, RELIEVO_UNIFORM = 2 };

typedef int32_t relievo_address_mode;
enum { RELIEVO_REPEAT = 0, RELIEVO_MIRROR = 1, RELIEVO_CLAMP = 2, RELIEVO_CLIP = 3 };

typedef int32_t relievo_height_filter;
enum { RELIEVO_EXACT = 0, RELIEVO_HARDWARE = 1 };

/* What a fragment stage writes. */
typedef int32_t relievo_aov;
enum {
  RELIEVO_AOV_COLOR = 0,
  RELIEVO_AOV_DEPTH = 1,
  RELIEVO_AOV_NORMAL = 2,
  RELIEVO_AOV_UV = 3,
  RELIEVO_AOV_STEPS = 4,
  RELIEVO_AOV_STATUS = 5,
  RELIEVO_AOV_RAY_ORIGIN = 6,
  RELIEVO_AOV_RAY_DIRECTION = 7
};

/* Registry: which techniques, stages and maps there are. */

typedef struct relievo_registry relievo_registry;

/* The embedded ones, and those in `folder_count` folders (NULL when 0). Thread-safe. */
relievo_status relievo_registry_load(const char* const* folders, size_t folder_count, relievo_registry** registry,
                                     relievo_error* error);
void relievo_registry_free(relievo_registry* registry);

/* How many of a kind. Thread-safe. */
relievo_status relievo_registry_count(const relievo_registry* registry, relievo_kind kind, size_t* count,
                                      relievo_error* error);

typedef struct relievo_description {
  relievo_string name, title, source, summary;
  relievo_string json; /* all that `relievo describe --json` says */
  size_t parameter_count;
} relievo_description;

/* The index-th of a kind, by name in alphabetical order. Thread-safe. */
relievo_status relievo_registry_at(const relievo_registry* registry, relievo_kind kind, size_t index,
                                   relievo_description* description, relievo_error* error);
/* By name; the error of an unknown one names the nearest. Thread-safe. */
relievo_status relievo_registry_find(const relievo_registry* registry, relievo_kind kind, const char* name,
                                     relievo_description* description, relievo_error* error);

typedef struct relievo_parameter {
  relievo_string name, title, unit;
  double minimum, maximum, default_value;
  relievo_binding_time binding;
  int32_t is_integer, is_loop;
} relievo_parameter;

/* The index-th parameter of what has this name. Thread-safe. */
relievo_status relievo_registry_parameter(const relievo_registry* registry, relievo_kind kind, const char* name,
                                          size_t index, relievo_parameter* parameter, relievo_error* error);

/* Programs: one permutation, composed and compiled. */

typedef struct relievo_program relievo_program;

typedef struct relievo_role {
  const char* role;      /* "view" in our stages */
  const char* technique; /* "relief" */
} relievo_role;

typedef struct relievo_value {
  const char* parameter; /* "relief.linear_steps" */
  double value;          /* of an axis: the index of its value (names: relievo_description) */
} relievo_value;

typedef struct relievo_binding_choice {
  const char* parameter;
  relievo_binding_time binding;
} relievo_binding_choice;

/* Zeros are the defaults. Each list may be NULL when its count is 0. */
typedef struct relievo_program_desc {
  const char* stage;     /* "surface" */
  const char* technique; /* for every role that `roles` does not name; may be NULL */
  const relievo_role* roles;
  size_t role_count;
  relievo_height_filter filter;
  relievo_address_mode address;
  relievo_aov aov;
  int32_t count_cost; /* not 0: instrumented, counts steps and fetches */
  const relievo_value* values;
  size_t value_count;
  const relievo_binding_choice* bindings; /* in place of the descriptors' */
  size_t binding_count;
  const char* const* targets; /* "glsl-450", "msl-2.2"; SPIR-V is always made */
  size_t target_count;
  int32_t skip_optimizer; /* not 0: as the front end leaves it */
  uint32_t threads;       /* 0 = the calling one alone. The outputs do not depend on it */
} relievo_program_desc;

/* Errors name the author's file and line. Thread-safe. */
relievo_status relievo_program_compile(const relievo_registry* registry, const relievo_program_desc* desc,
                                       relievo_program** program, relievo_error* error);
void relievo_program_free(relievo_program* program);
/* Another handle of the same program, with views of its own; to be freed as well. Thread-safe. */
relievo_status relievo_program_share(const relievo_program* program, relievo_program** another, relievo_error* error);

/* "surface/view=relief/exact/repeat/color". Thread-safe. */
relievo_status relievo_program_key(const relievo_program* program, relievo_string* key, relievo_error* error);
/* The shaders in pipeline order. Thread-safe, as are all below that read a program. */
relievo_status relievo_program_shader_count(const relievo_program* program, size_t* count, relievo_error* error);
relievo_status relievo_program_shader_stage(const relievo_program* program, size_t index, relievo_shader_stage* stage,
                                            relievo_error* error);
/* The source of one shader for a target that was asked for, or its words for "spirv-1.0". */
relievo_status relievo_program_output(const relievo_program* program, relievo_shader_stage stage, const char* target,
                                      relievo_bytes* output, relievo_error* error);

typedef int32_t relievo_resource_kind;
enum {
  RELIEVO_UNIFORM_BUFFER = 0,
  RELIEVO_STORAGE_BUFFER = 1,
  RELIEVO_SAMPLED_TEXTURE = 2,
  RELIEVO_STORAGE_TEXTURE = 3
};

typedef struct relievo_binding {
  relievo_string name; /* the GLSL name: of the block for buffers, of the uniform for textures */
  relievo_string map;  /* that belongs there: "height", or empty */
  relievo_resource_kind kind;
  int32_t set, binding;
  int32_t gl_slot;     /* in OpenGL's namespace of the kind */
  int32_t is_filtered; /* sampled textures: some shader samples it; else any filter of the sampler will do */
} relievo_binding;

relievo_status relievo_program_binding_count(const relievo_program* program, size_t* count, relievo_error* error);
relievo_status relievo_program_binding(const relievo_program* program, size_t index, relievo_binding* binding,
                                       relievo_error* error);

typedef struct relievo_program_parameter {
  relievo_string name; /* "relief.linear_steps" */
  relievo_binding_time binding;
  int32_t is_integer, is_loop;
  int32_t offset;      /* uniforms: bytes in the parameter block, else -1 */
  int32_t constant_id; /* specialization constants, else -1 */
  double value;        /* of this permutation */
  double default_value;
} relievo_program_parameter;

relievo_status relievo_program_parameter_count(const relievo_program* program, size_t* count, relievo_error* error);
relievo_status relievo_program_parameter_at(const relievo_program* program, size_t index,
                                            relievo_program_parameter* parameter, relievo_error* error);
/* The contents of the block at set 0, binding 0 (std140) for the values of this permutation; may be empty. */
relievo_status relievo_program_parameter_block(const relievo_program* program, relievo_bytes* block,
                                               relievo_error* error);
/* JSON, docs/reflection.md. */
relievo_status relievo_program_reflection(const relievo_program* program, relievo_string* json, relievo_error* error);

/* Manifests: every permutation of a project. */

typedef struct relievo_manifest relievo_manifest;

/* Reads a relievo.toml and the descriptors of its folders and of `folders`, expands and prunes; compiles nothing.
 * Thread-safe. */
relievo_status relievo_manifest_load(const char* path, const char* const* folders, size_t folder_count,
                                     relievo_manifest** manifest, relievo_error* error);
void relievo_manifest_free(relievo_manifest* manifest);
/* How many permutations are asked for, and how many of them are kept for at least one target. Thread-safe. */
relievo_status relievo_manifest_counts(const relievo_manifest* manifest, size_t* asked, size_t* kept,
                                       relievo_error* error);
/* The archive's name in the manifest. Thread-safe. */
relievo_status relievo_manifest_name(const relievo_manifest* manifest, relievo_string* name, relievo_error* error);

/* Called from any thread, one at a time. Must neither throw nor jump out. */
typedef void (*relievo_progress)(void* user, size_t done, size_t total);

/* Zeros are the defaults. */
typedef struct relievo_permute_desc {
  const char* archive;  /* the file to write */
  uint32_t threads;     /* 0 = all. The archive does not depend on it */
  uint32_t shard_index; /* from 0 */
  uint32_t shard_count; /* 0 = 1: everything */
  int32_t keep_going;   /* not 0: after an error, an archive without the permutations that failed */
  const char* cache;    /* NULL = none; "" = the user's; a folder, or "redis://host[:port][/database]" */
  uint64_t cache_bytes; /* 0 = 2 GiB; else at least 1 MiB */
  relievo_progress progress;
  void* user;
} relievo_permute_desc;

typedef struct relievo_summary relievo_summary;

/* Compiles and writes the archive. `summary` is made whenever the run came to its end: also with the status
 * RELIEVO_ERROR_COMPILE, when shaders failed; `error` then is the most frequent one. Thread-safe; of runs that
 * write one archive at once, the last one's stays, whole. */
relievo_status relievo_manifest_permute(const relievo_manifest* manifest, const relievo_permute_desc* desc,
                                        relievo_summary** summary, relievo_error* error);
void relievo_summary_free(relievo_summary* summary);

typedef struct relievo_counts {
  size_t asked;      /* permutations in the shard */
  size_t pruned;     /* of them, for every target */
  size_t closures;   /* different sources with different frozen constants */
  size_t programs;   /* different programs among them */
  size_t from_cache; /* closures */
  size_t compiled;   /* closures */
  size_t failed;     /* permutations */
  size_t errors;     /* different ones */
} relievo_counts;

/* Thread-safe. */
relievo_status relievo_summary_counts(const relievo_summary* summary, relievo_counts* counts, relievo_error* error);
/* The index-th error, the most frequent first, and how many permutations have it. Thread-safe. */
relievo_status relievo_summary_error(const relievo_summary* summary, size_t index, relievo_error* folded, size_t* count,
                                     relievo_error* error);

/* Hot reload: programs that follow their sources while an application runs (docs/hot-reload.md). */

typedef struct relievo_reloader relievo_reloader;

/* A program of one reloader: not 0, and never used again. */
typedef uint64_t relievo_reload_id;

/* Without an error: `program` is what `ids`, one of them, is from now on; when there is none, what was wrong with the
 * folders is mended. With an error, at the author's file and line: `ids` stay what they were; when there are none, a
 * descriptor or folder is wrong, and all stay what they were. Lives until the callback returns: relievo_program_share
 * keeps the program. */
typedef struct relievo_reload_event {
  const relievo_reload_id* ids;
  size_t id_count;
  const relievo_program* program; /* or NULL */
  const relievo_error* error;     /* or NULL */
} relievo_reload_event;

/* Called from the reloader's own thread, or by relievo_reloader_poll, one at a time. May call every function on the
 * reloader but relievo_reloader_free. Must neither throw nor jump out. */
typedef void (*relievo_reload_callback)(void* user, const relievo_reload_event* event);

/* Zeros are the defaults. */
typedef struct relievo_reload_desc {
  const char* const* folders; /* of technique, map and stage folders, besides our own; NULL when `folder_count` is 0 */
  size_t folder_count;
  uint32_t interval_ms; /* between two looks of the reloader's own thread; 0: no thread, the application polls */
  uint32_t settle_ms;   /* files must have stayed as they are for this long; 0 = 50 */
  uint32_t threads;     /* for compiling several programs; 0 = all */
  relievo_reload_callback callback; /* NULL: the application asks relievo_reloader_current */
  void* user;
} relievo_reload_desc;

/* Reads the folders once, before it returns. Thread-safe, as is every function on a reloader but
 * relievo_reloader_free. */
relievo_status relievo_reloader_create(const relievo_reload_desc* desc, relievo_reloader** reloader,
                                       relievo_error* error);
/* Waits for a callback that is running; no other comes. Programs that it gave stay. Not thread-safe. */
void relievo_reloader_free(relievo_reloader* reloader);

/* Compiled at the next look, at once by a thread of its own: the callback gets it, or its error. `technique` stands for
 * the roles that the stage has now. */
relievo_status relievo_reloader_add(relievo_reloader* reloader, const relievo_program_desc* desc, relievo_reload_id* id,
                                    relievo_error* error);
/* Only a callback that is under way may still name the program. One that is not there is no error. */
relievo_status relievo_reloader_remove(relievo_reloader* reloader, relievo_reload_id id, relievo_error* error);
/* The program as it was last told, to be freed; NULL before, and for one that is not there. */
relievo_status relievo_reloader_current(const relievo_reloader* reloader, relievo_reload_id id,
                                        relievo_program** program, relievo_error* error);
/* Looks once, and recompiles what has to be; `reloaded` is how many programs the callback was told to be new. Does
 * nothing when called by the callback, or while another thread polls. */
relievo_status relievo_reloader_poll(relievo_reloader* reloader, size_t* reloaded, relievo_error* error);

/* What a reloader did since it began. */
typedef struct relievo_reload_counts {
  uint64_t looks;    /* at names, sizes and times */
  uint64_t loads;    /* of all sources, since something looked different */
  uint64_t composed; /* programs that a changed file may have reached */
  uint64_t compiled; /* of them, those that came out different; with those that failed */
} relievo_reload_counts;

relievo_status relievo_reloader_counts(const relievo_reloader* reloader, relievo_reload_counts* counts,
                                       relievo_error* error);

/* Archives. */

typedef struct relievo_archive relievo_archive;
typedef uint32_t relievo_entry;

typedef struct relievo_assignment {
  const char* axis;  /* "technique" */
  const char* value; /* "relief" */
} relievo_assignment;

/* Maps the file, which must not be changed while it is open; replacing it is fine. Thread-safe, as is every function on
 * an archive. */
relievo_status relievo_archive_open(const char* path, relievo_archive** archive, relievo_error* error);
void relievo_archive_free(relievo_archive* archive);
/* Permutations and different programs. */
relievo_status relievo_archive_counts(const relievo_archive* archive, size_t* permutations, size_t* programs,
                                      relievo_error* error);

typedef struct relievo_axis {
  relievo_string name;
  size_t value_count, default_value;
} relievo_axis;

relievo_status relievo_archive_axis_count(const relievo_archive* archive, size_t* count, relievo_error* error);
relievo_status relievo_archive_axis(const relievo_archive* archive, size_t index, relievo_axis* axis,
                                    relievo_error* error);
relievo_status relievo_archive_axis_value(const relievo_archive* archive, size_t axis, size_t index,
                                          relievo_string* value, relievo_error* error);
relievo_status relievo_archive_target_count(const relievo_archive* archive, size_t* count, relievo_error* error);
relievo_status relievo_archive_target(const relievo_archive* archive, size_t index, relievo_string* target,
                                      relievo_error* error);

/* The key of an assignment; axes that are left out are at their default. */
relievo_status relievo_archive_key(const relievo_archive* archive, const relievo_assignment* assignment, size_t count,
                                   uint64_t* key, relievo_error* error);
/* O(1), allocates nothing when the key is there. */
relievo_status relievo_archive_find_key(const relievo_archive* archive, uint64_t key, relievo_entry* entry,
                                        relievo_error* error);
/* The error "archive.missing" names the nearest permutations that are there, and how they differ. */
relievo_status relievo_archive_find(const relievo_archive* archive, const relievo_assignment* assignment, size_t count,
                                    relievo_entry* entry, relievo_error* error);

/* An entry's key, and its program: equal for permutations that share one. */
relievo_status relievo_archive_entry(const relievo_archive* archive, relievo_entry entry, uint64_t* key,
                                     uint32_t* program, relievo_error* error);
/* "technique=relief address=clamp": what is not default, cut to `capacity` bytes with the zero at the end; `size` is
 * what it takes, without the zero. `buffer` may be NULL when `capacity` is 0. */
relievo_status relievo_archive_entry_name(const relievo_archive* archive, relievo_entry entry, char* buffer,
                                          size_t capacity, size_t* size, relievo_error* error);

typedef struct relievo_output {
  relievo_shader_stage stage;
  relievo_string target;
  uint64_t size; /* bytes */
} relievo_output;

/* What an entry has: the first `capacity` of `count`. `outputs` may be NULL when `capacity` is 0. */
relievo_status relievo_archive_outputs(const relievo_archive* archive, relievo_entry entry, relievo_output* outputs,
                                       size_t capacity, size_t* count, relievo_error* error);
/* One shader for one target, checked against its hash. Text, or SPIR-V. */
relievo_status relievo_archive_output(const relievo_archive* archive, relievo_entry entry, relievo_shader_stage stage,
                                      const char* target, relievo_bytes* output, relievo_error* error);
/* JSON, docs/reflection.md; no zero follows here. */
relievo_status relievo_archive_reflection(const relievo_archive* archive, relievo_entry entry, relievo_bytes* json,
                                          relievo_error* error);
/* JSON, docs/permutations.md; no zero follows here. */
relievo_status relievo_archive_cost(const relievo_archive* archive, relievo_entry entry, relievo_bytes* json,
                                    relievo_error* error);
/* Reads and checks every byte. */
relievo_status relievo_archive_verify(const relievo_archive* archive, relievo_error* error);

/* Maps: what techniques read besides the heights. */

typedef struct relievo_map relievo_map;

/* Zeros are the defaults. */
typedef struct relievo_bake_desc {
  const char* map;      /* "cone" */
  const float* heights; /* width * height floats in [0,1], row 0 first */
  int32_t width, height;
  relievo_address_mode address;
  const relievo_value* values; /* "cone.bits" */
  size_t value_count;
  const char* backend; /* "vulkan", "opengl" */
} relievo_bake_desc;

typedef int32_t relievo_map_dimension;
enum { RELIEVO_FLAT = 0, RELIEVO_ARRAY = 1, RELIEVO_VOLUME = 2 };

typedef struct relievo_map_info {
  relievo_string name;
  int32_t width, height; /* texels of level 0; level k has max(1, extent >> k) */
  int32_t depth;         /* layers of an array or a volume, one after another */
  int32_t channels;      /* 1-4, interleaved */
  int32_t levels;        /* one after another, tightly packed */
  int32_t bits;          /* 8, 16: every value is k / (2^bits - 1); 32: floats */
  relievo_map_dimension dimension;
  relievo_address_mode address;
  const float* texels;
  size_t texel_floats; /* how many floats there are */
  int32_t is_uint;     /* shaders read the whole numbers k: a texture of unsigned integers; else unorm or float */
} relievo_map_info;

/* Bakes a map, and first what it needs. RELIEVO_ERROR_UNSUPPORTED where the backend has no driver here. Thread-safe:
 * every call opens the backend for itself. */
relievo_status relievo_map_bake(const relievo_registry* registry, const relievo_bake_desc* desc, relievo_map** map,
                                relievo_error* error);
void relievo_map_free(relievo_map* map);
/* Thread-safe. */
relievo_status relievo_map_get(const relievo_map* map, relievo_map_info* info, relievo_error* error);

/* Rays: where they first meet the surface, found by a technique on a backend, or exactly, on the CPU. */

typedef struct relievo_tracer relievo_tracer;

/* Zeros are the defaults. */
typedef struct relievo_trace_desc {
  const char* technique; /* "relief"; not looked at with the backend "oracle" */
  const char* backend;   /* "vulkan", "opengl"; "oracle" finds exact first hits on the CPU, in double precision */
  const float* heights;  /* width * height floats in [0,1], row 0 first; copied */
  int32_t width, height;
  relievo_address_mode address;
  relievo_height_filter filter; /* of a technique; the oracle's surface is bilinear, as RELIEVO_EXACT makes it */
  const relievo_value* values;  /* "relief.linear_steps", "cone.bits" */
  size_t value_count;
  uint32_t threads; /* of the oracle; 0 = all */
} relievo_trace_desc;

/* In texture coordinates and H: 0 on the base, 1 on the lid. The point at t is (u, v, h) + t * (du, dv, dh). */
typedef struct relievo_ray {
  double u, v, h;
  double du, dv, dh;
  double t_max; /* the ray ends there; INFINITY, or any number from 0 on */
} relievo_ray;

typedef int32_t relievo_hit_status;
enum {
  RELIEVO_MISS = 0,      /* left between base and lid without a hit, or came to t_max; rays that are not finite */
  RELIEVO_HIT = 1,       /* at t, for the first time, the ray is not above the surface */
  RELIEVO_EXHAUSTED = 2, /* the technique ran out of steps */
  RELIEVO_INSIDE = 3,    /* starts below the surface; t is 0 */
  RELIEVO_OUTSIDE = 4    /* left the map, with RELIEVO_CLIP */
};

/* Of what is no hit, t is where the search ended. */
typedef struct relievo_hit {
  relievo_hit_status status;
  int32_t ambiguous; /* oracle only, not 0: passes within 1e-5 H of the surface before t without touching it */
  double t, u, v, h;
  uint32_t steps, fetches; /* loop iterations, of the oracle cells; and texel reads */
} relievo_hit;

/* Opens the backend, bakes the maps and traces one ray, so that what is wrong is said here. RELIEVO_ERROR_UNSUPPORTED
 * where the backend has no driver here. Thread-safe. */
relievo_status relievo_tracer_create(const relievo_registry* registry, const relievo_trace_desc* desc,
                                     relievo_tracer** tracer, relievo_error* error);
void relievo_tracer_free(relievo_tracer* tracer);
/* One hit a ray, in order; both may be NULL when there are none. Thread-safe: on a backend, calls wait for each other. */
relievo_status relievo_tracer_trace(const relievo_tracer* tracer, const relievo_ray* rays, size_t count,
                                    relievo_hit* hits, relievo_error* error);

#ifdef __cplusplus
}
#endif

#endif
