/* A C99 program that uses the SDK as an engine would: compiles a program, has a manifest compiled into an archive, reads
 * it, edits a technique while a reloader watches it, bakes a map, traces rays. Arguments: a manifest, one with errors, a
 * folder to write into (with an empty folder techniques/edited), a folder with a technique called `broken`. */
#include <relievo.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"

int failures = 0;

/* Says why a call failed that should not have. */
int succeeds(relievo_status status, const relievo_error* error, const char* file, int line) {
  if (status == RELIEVO_OK) return 1;
  ++failures;
  fprintf(stderr, "%s:%d: [%s] %s (%s:%d)\n", file, line, error->id, error->message, error->file, (int)error->line);
  return 0;
}

static void use_version(void) {
  const relievo_string version = relievo_version();
  CHECK(version.size == strlen(version.data));
  CHECK(strstr(relievo_compiler_version().data, version.data) != NULL);
  printf("relievo %s\n", version.data);
}

static void use_registry(const relievo_registry* registry) {
  relievo_error error;
  relievo_description description;
  relievo_parameter parameter;
  size_t counts[3], i, steps = 0;
  relievo_kind kind;
  for (kind = RELIEVO_TECHNIQUE; kind <= RELIEVO_MAP; ++kind) {
    OK(relievo_registry_count(registry, kind, &counts[kind], &error));
    for (i = 0; i < counts[kind]; ++i) {
      relievo_description again;
      if (!OK(relievo_registry_at(registry, kind, i, &description, &error))) return;
      if (!OK(relievo_registry_find(registry, kind, description.name.data, &again, &error))) return;
      CHECK(again.json.data == description.json.data && description.json.data[0] == '{');
    }
    CHECK(relievo_registry_at(registry, kind, counts[kind], &description, &error) == RELIEVO_ERROR_USAGE);
  }
  printf("%u techniques, %u stages, %u maps\n", (unsigned)counts[0], (unsigned)counts[1], (unsigned)counts[2]);
  CHECK(counts[0] > 5 && counts[1] > 2 && counts[2] > 3);
  if (!OK(relievo_registry_find(registry, RELIEVO_TECHNIQUE, "relief", &description, &error))) return;
  for (i = 0; i < description.parameter_count; ++i) {
    if (!OK(relievo_registry_parameter(registry, RELIEVO_TECHNIQUE, "relief", i, &parameter, &error))) return;
    if (strcmp(parameter.name.data, "linear_steps") != 0) continue;
    ++steps;
    CHECK(parameter.is_loop && parameter.is_integer && parameter.minimum <= parameter.default_value);
  }
  CHECK(steps == 1);
  CHECK(relievo_registry_find(registry, RELIEVO_TECHNIQUE, "relif", &description, &error) == RELIEVO_ERROR_USAGE);
  CHECK(strcmp(error.id, "describe.unknown-technique") == 0 && strstr(error.message, "\"relief\"") != NULL);
}

static void check_parameters(const relievo_program* program) {
  relievo_error error;
  relievo_program_parameter parameter;
  relievo_bytes block;
  size_t count = 0, i, seen = 0;
  OK(relievo_program_parameter_count(program, &count, &error));
  OK(relievo_program_parameter_block(program, &block, &error));
  for (i = 0; i < count; ++i) {
    if (!OK(relievo_program_parameter_at(program, i, &parameter, &error))) return;
    if (strcmp(parameter.name.data, "relief.linear_steps") == 0) {
      int32_t steps = 0;
      ++seen;
      CHECK(parameter.value == 48 && parameter.binding == RELIEVO_UNIFORM && parameter.constant_id == -1);
      CHECK(parameter.offset >= 0 && (size_t)parameter.offset + 4 <= block.size);
      memcpy(&steps, (const char*)block.data + parameter.offset, 4);
      CHECK(steps == 48);
    }
    if (strcmp(parameter.name.data, "relief.binary_steps") == 0) {
      ++seen;
      CHECK(parameter.binding == RELIEVO_SPECIALIZATION && parameter.constant_id >= 0 && parameter.offset == -1);
    }
  }
  CHECK(seen == 2);
  CHECK(relievo_program_parameter_at(program, count, &parameter, &error) == RELIEVO_ERROR_USAGE);
}

static void check_bindings(const relievo_program* program) {
  relievo_error error;
  relievo_binding binding;
  size_t count = 0, i, heights = 0, blocks = 0;
  OK(relievo_program_binding_count(program, &count, &error));
  for (i = 0; i < count; ++i) {
    if (!OK(relievo_program_binding(program, i, &binding, &error))) return;
    if (strcmp(binding.map.data, "height") == 0) heights += binding.kind == RELIEVO_SAMPLED_TEXTURE;
    if (binding.set == 0 && binding.binding == 0) blocks += binding.kind == RELIEVO_UNIFORM_BUFFER;
  }
  CHECK(heights == 1 && blocks == 1);
}

static void check_outputs(const relievo_program* program) {
  static const char* const targets[] = {"spirv-1.0", "glsl-450", "hlsl-5.0"};
  relievo_error error;
  relievo_bytes output;
  relievo_shader_stage stage;
  size_t count = 0, i, k;
  OK(relievo_program_shader_count(program, &count, &error));
  CHECK(count == 2);
  for (i = 0; i < count; ++i) {
    if (!OK(relievo_program_shader_stage(program, i, &stage, &error))) return;
    for (k = 0; k < 3; ++k) {
      if (!OK(relievo_program_output(program, stage, targets[k], &output, &error))) return;
      printf("shader %d for %s: %u bytes\n", (int)stage, targets[k], (unsigned)output.size);
      CHECK(output.size > 100);
    }
  }
  CHECK(relievo_program_output(program, RELIEVO_GEOMETRY, "glsl-450", &output, &error) == RELIEVO_ERROR_USAGE);
  CHECK(strstr(error.message, "geometry") != NULL);
  CHECK(relievo_program_output(program, RELIEVO_VERTEX, "msl-2.2", &output, &error) == RELIEVO_ERROR_USAGE);
  CHECK(strcmp(error.id, "c.no-output") == 0 && strstr(error.message, "msl-2.2") != NULL);
  CHECK(relievo_program_output(program, 17, "glsl-450", &output, &error) == RELIEVO_ERROR_USAGE);
  CHECK(strcmp(error.id, "c.enum") == 0);
}

static void use_program(const relievo_registry* registry) {
  static const char* const targets[] = {"glsl-450", "hlsl-5.0"};
  const relievo_value values[] = {{"relief.linear_steps", 48}};
  const relievo_binding_choice bindings[] = {{"relief.linear_steps", RELIEVO_UNIFORM},
                                             {"relief.binary_steps", RELIEVO_SPECIALIZATION}};
  relievo_program_desc desc;
  relievo_program* program = NULL;
  relievo_error error;
  relievo_string text;
  memset(&desc, 0, sizeof desc);
  desc.stage = "surface";
  desc.technique = "relief";
  desc.address = RELIEVO_CLAMP;
  desc.values = values;
  desc.value_count = 1;
  desc.bindings = bindings;
  desc.binding_count = 2;
  desc.targets = targets;
  desc.target_count = 2;
  if (!OK(relievo_program_compile(registry, &desc, &program, &error))) return;
  OK(relievo_program_key(program, &text, &error));
  CHECK(strstr(text.data, "view=relief") != NULL && strstr(text.data, "exact/clamp") != NULL);
  OK(relievo_program_reflection(program, &text, &error));
  CHECK(text.size == strlen(text.data) && strstr(text.data, "\"schema\"") != NULL);
  check_outputs(program);
  check_bindings(program);
  check_parameters(program);
  relievo_program_free(program);
  program = NULL;
  desc.address = 4;
  CHECK(relievo_program_compile(registry, &desc, &program, &error) == RELIEVO_ERROR_USAGE && program == NULL);
  CHECK(strcmp(error.id, "c.enum") == 0 && strstr(error.message, "address") != NULL);
  desc.address = RELIEVO_REPEAT;
  desc.stage = "prism"; /* needs geometry shaders */
  CHECK(relievo_program_compile(registry, &desc, &program, &error) == RELIEVO_ERROR_UNSUPPORTED && program == NULL);
  CHECK(strstr(error.message, "prism_pulled") != NULL);
}

static void use_broken_technique(const char* folder) {
  relievo_registry* registry = NULL;
  relievo_program* program = NULL;
  relievo_program_desc desc;
  relievo_error error;
  if (!OK(relievo_registry_load(&folder, 1, &registry, &error))) return;
  memset(&desc, 0, sizeof desc);
  desc.stage = "surface";
  desc.technique = "broken";
  CHECK(relievo_program_compile(registry, &desc, &program, &error) == RELIEVO_ERROR_COMPILE && program == NULL);
  CHECK(error.code == RELIEVO_ERROR_COMPILE && error.line == 3);
  CHECK(strncmp(error.file, folder, strlen(folder)) == 0 && strstr(error.file, "broken.glsl") != NULL);
  printf("%s:%d: %s\n", error.file, (int)error.line, error.message);
  relievo_registry_free(registry);
}

static size_t calls = 0;
static void count_progress(void* user, size_t done, size_t total) {
  CHECK(user == &calls && done <= total);
  ++calls;
}

/* Returns whether the archive is there. */
static int use_manifest(const char* path, const char* archive, const char* cache) {
  relievo_manifest* manifest = NULL;
  relievo_summary* summary = NULL;
  relievo_permute_desc desc;
  relievo_counts counts;
  relievo_string name;
  relievo_error error;
  size_t asked = 0, kept = 0;
  if (!OK(relievo_manifest_load(path, NULL, 0, &manifest, &error))) return 0;
  OK(relievo_manifest_counts(manifest, &asked, &kept, &error));
  CHECK(asked == 4 && kept == 4);
  OK(relievo_manifest_name(manifest, &name, &error));
  CHECK(strcmp(name.data, "sample") == 0);
  memset(&desc, 0, sizeof desc);
  desc.archive = archive;
  desc.cache = cache;
  desc.progress = count_progress;
  desc.user = &calls;
  if (OK(relievo_manifest_permute(manifest, &desc, &summary, &error))) {
    OK(relievo_summary_counts(summary, &counts, &error));
    CHECK(counts.asked == 4 && counts.failed == 0 && counts.errors == 0 && calls > 0);
    CHECK(counts.compiled + counts.from_cache == counts.closures);
    CHECK(relievo_summary_error(summary, 0, &error, &asked, NULL) == RELIEVO_ERROR_USAGE);
    printf("%u programs, %u compiled\n", (unsigned)counts.programs, (unsigned)counts.compiled);
    relievo_summary_free(summary);
  }
  desc.shard_index = 2;
  desc.shard_count = 2;
  summary = NULL;
  CHECK(relievo_manifest_permute(manifest, &desc, &summary, &error) == RELIEVO_ERROR_USAGE && summary == NULL);
  relievo_manifest_free(manifest);
  return 1;
}

/* Every permutation of the manifest has an error of its own technique. */
static void use_failing_manifest(const char* path, const char* archive) {
  relievo_manifest* manifest = NULL;
  relievo_summary* summary = NULL;
  relievo_permute_desc desc;
  relievo_counts counts;
  relievo_error error, folded;
  size_t count = 0;
  if (!OK(relievo_manifest_load(path, NULL, 0, &manifest, &error))) return;
  memset(&desc, 0, sizeof desc);
  desc.archive = archive;
  CHECK(relievo_manifest_permute(manifest, &desc, &summary, &error) == RELIEVO_ERROR_COMPILE);
  CHECK(summary != NULL && error.line == 3 && strstr(error.file, "broken.glsl") != NULL);
  if (summary) {
    OK(relievo_summary_counts(summary, &counts, &error));
    CHECK(counts.failed == 2 && counts.errors == 1);
    OK(relievo_summary_error(summary, 0, &folded, &count, &error));
    CHECK(count == 2 && folded.line == 3);
  }
  relievo_summary_free(summary);
  relievo_manifest_free(manifest);
}

static void check_entry(const relievo_archive* archive, relievo_entry entry) {
  relievo_error error;
  relievo_output outputs[8];
  relievo_bytes bytes;
  char name[64], cut[8];
  size_t size = 0, count = 0, i;
  uint64_t key = 0;
  uint32_t program = 0;
  OK(relievo_archive_entry(archive, entry, &key, &program, &error));
  OK(relievo_archive_entry_name(archive, entry, name, sizeof name, &size, &error));
  CHECK(size == strlen(name) && strcmp(name, "technique=relief address=clamp") == 0);
  OK(relievo_archive_entry_name(archive, entry, cut, sizeof cut, &size, &error));
  CHECK(size == strlen(name) && strcmp(cut, "techniq") == 0);
  OK(relievo_archive_outputs(archive, entry, outputs, 8, &count, &error));
  CHECK(count == 4);
  for (i = 0; i < count && i < 8; ++i) {
    if (!OK(relievo_archive_output(archive, entry, outputs[i].stage, outputs[i].target.data, &bytes, &error))) continue;
    CHECK(bytes.size == outputs[i].size);
    printf("%s: shader %d for %s: %u bytes\n", name, (int)outputs[i].stage, outputs[i].target.data,
           (unsigned)bytes.size);
  }
  OK(relievo_archive_reflection(archive, entry, &bytes, &error));
  CHECK(bytes.size > 2 && *(const char*)bytes.data == '{');
  OK(relievo_archive_cost(archive, entry, &bytes, &error));
  CHECK(bytes.size > 2 && *(const char*)bytes.data == '{');
  CHECK(relievo_archive_output(archive, entry, RELIEVO_VERTEX, "msl-2.2", &bytes, &error) != RELIEVO_OK);
  CHECK(strcmp(error.id, "archive.no-output") == 0);
}

static void use_archive(const char* path) {
  const relievo_assignment wanted[] = {{"technique", "relief"}, {"address", "clamp"}};
  const relievo_assignment missing[] = {{"technique", "relief"}, {"address", "clip"}};
  relievo_archive* archive = NULL;
  relievo_error error;
  relievo_entry entry = 0, by_key = 1;
  relievo_axis axis;
  relievo_string text;
  size_t permutations = 0, programs = 0, count = 0;
  uint64_t key = 0;
  if (!OK(relievo_archive_open(path, &archive, &error))) return;
  OK(relievo_archive_verify(archive, &error));
  OK(relievo_archive_counts(archive, &permutations, &programs, &error));
  CHECK(permutations == 4 && programs == 4);
  OK(relievo_archive_axis_count(archive, &count, &error));
  OK(relievo_archive_axis(archive, 0, &axis, &error));
  OK(relievo_archive_axis_value(archive, 0, axis.default_value, &text, &error));
  CHECK(count >= 2 && axis.value_count >= 1 && text.size == strlen(text.data));
  OK(relievo_archive_target_count(archive, &count, &error));
  OK(relievo_archive_target(archive, 0, &text, &error));
  CHECK(count == 2 && strcmp(text.data, "spirv-1.0") == 0);
  OK(relievo_archive_key(archive, wanted, 2, &key, &error));
  OK(relievo_archive_find_key(archive, key, &by_key, &error));
  OK(relievo_archive_find(archive, wanted, 2, &entry, &error));
  CHECK(entry == by_key);
  check_entry(archive, entry);
  CHECK(relievo_archive_find_key(archive, key + 1, &entry, &error) == RELIEVO_ERROR_USAGE);
  CHECK(strcmp(error.id, "archive.missing") == 0);
  CHECK(relievo_archive_find(archive, missing, 2, &entry, &error) == RELIEVO_ERROR_USAGE);
  CHECK(strcmp(error.id, "archive.missing") == 0 && strstr(error.message, "address") != NULL);
  printf("%s\n", error.message);
  CHECK(relievo_archive_entry(archive, 4, &key, &(uint32_t){0}, &error) == RELIEVO_ERROR_USAGE);
  relievo_archive_free(archive);
  archive = NULL;
  CHECK(relievo_archive_open("/nonexistent.rla", &archive, &error) == RELIEVO_ERROR_IO && archive == NULL);
}

static void use_maps(const relievo_registry* registry) {
  enum { extent = 8 };
  static const relievo_value misspelt[] = {{"cone.bit", 8}};
  float heights[extent * extent];
  relievo_bake_desc desc;
  relievo_map* map = NULL;
  relievo_map_info info;
  relievo_error error;
  size_t i, steep = 0;
  for (i = 0; i < extent * extent; ++i) heights[i] = (float)(i % extent) / extent;
  memset(&desc, 0, sizeof desc);
  desc.map = "normal";
  desc.heights = heights;
  desc.width = desc.height = extent;
  desc.address = RELIEVO_CLAMP;
  desc.backend = "vulkan";
  if (OK(relievo_map_bake(registry, &desc, &map, &error))) {
    OK(relievo_map_get(map, &info, &error));
    CHECK(info.width == extent && info.height == extent && info.address == RELIEVO_CLAMP);
    CHECK(info.texel_floats == (size_t)(info.width * info.height * info.channels));
    for (i = 0; i < info.texel_floats; ++i) {
      CHECK(isfinite(info.texels[i]));
      steep += info.texels[i] != info.texels[0];
    }
    CHECK(steep > 0); /* a slope is not flat */
    printf("%s: %d x %d, %d channels\n", info.name.data, (int)info.width, (int)info.height, (int)info.channels);
    relievo_map_free(map);
  }
  map = NULL;
  desc.backend = "vulkn";
  CHECK(relievo_map_bake(registry, &desc, &map, &error) == RELIEVO_ERROR_USAGE && map == NULL);
  CHECK(strcmp(error.id, "backend.unknown") == 0);
  desc.backend = "vulkan";
  desc.values = misspelt;
  desc.value_count = 1;
  CHECK(relievo_map_bake(registry, &desc, &map, &error) == RELIEVO_ERROR_USAGE && map == NULL);
  CHECK(strcmp(error.id, "c.parameter") == 0 && strstr(error.message, "'cone.bits'") != NULL);
  desc.value_count = 0;
  heights[9] = NAN;
  CHECK(relievo_map_bake(registry, &desc, &map, &error) == RELIEVO_ERROR_USAGE && map == NULL);
  CHECK(strcmp(error.id, "c.height") == 0 && strstr(error.message, "(1, 1)") != NULL);
  desc.width = -1;
  CHECK(relievo_map_bake(registry, &desc, &map, &error) == RELIEVO_ERROR_USAGE && map == NULL);
}

/* A ramp from 0 at the left to 7/8: the technique finds what the oracle finds. */
static void use_rays(const relievo_registry* registry) {
  enum { extent = 8, rays = 16 };
  float heights[extent * extent];
  relievo_ray ray[rays];
  relievo_hit truth[rays], hit[rays];
  relievo_trace_desc desc;
  relievo_tracer *oracle = NULL, *tracer = NULL;
  relievo_error error;
  size_t i;
  for (i = 0; i < extent * extent; ++i) heights[i] = (float)(i % extent) / extent;
  for (i = 0; i < rays; ++i) {
    const relievo_ray down = {0.1 + i / 32.0, 0.3, 1, 0.25, 0.125, -1, INFINITY};
    ray[i] = down;
  }
  memset(&desc, 0, sizeof desc);
  desc.heights = heights;
  desc.width = desc.height = extent;
  desc.address = RELIEVO_CLAMP;
  desc.backend = "oracle";
  OK(relievo_tracer_create(registry, &desc, &oracle, &error));
  desc.backend = "vulkan";
  desc.technique = "quadrant_maxima";
  OK(relievo_tracer_create(registry, &desc, &tracer, &error));
  if (oracle && tracer && OK(relievo_tracer_trace(oracle, ray, rays, truth, &error)) &&
      OK(relievo_tracer_trace(tracer, ray, rays, hit, &error))) {
    for (i = 0; i < rays; ++i) {
      CHECK(truth[i].status == RELIEVO_HIT && hit[i].status == RELIEVO_HIT);
      CHECK(fabs(hit[i].t - truth[i].t) < 1e-5);
    }
    printf("first hit at t = %.6f\n", hit[0].t);
  }
  relievo_tracer_free(oracle);
  relievo_tracer_free(tracer);
}

int main(int argc, char** argv) {
  relievo_registry* registry = NULL;
  relievo_error error;
  char archive[512], broken[512], cache[512], edited[512];
  if (argc != 5) {
    fprintf(stderr, "usage: %s MANIFEST BROKEN_MANIFEST FOLDER BROKEN_FOLDER\n", argv[0]);
    return 2;
  }
  snprintf(archive, sizeof archive, "%s/sample.rla", argv[3]);
  snprintf(broken, sizeof broken, "%s/broken.rla", argv[3]);
  snprintf(cache, sizeof cache, "%s/cache", argv[3]);
  snprintf(edited, sizeof edited, "%s/techniques", argv[3]);
  use_version();
  if (OK(relievo_registry_load(NULL, 0, &registry, &error))) {
    use_registry(registry);
    use_program(registry);
    use_maps(registry);
    use_rays(registry);
  }
  relievo_registry_free(registry);
  use_broken_technique(argv[4]);
  if (use_manifest(argv[1], archive, cache)) use_archive(archive);
  use_failing_manifest(argv[2], broken);
  use_reloader(edited);
  use_reloading_thread();
  printf(failures == 0 ? "all as expected\n" : "%d failures\n", failures);
  return failures == 0 ? 0 : 1;
}
