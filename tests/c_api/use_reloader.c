/* Programs that follow their sources, from C. */
#include <string.h>
#include <time.h>

#include "check.h"

/* What a callback was told. */
typedef struct told {
  size_t programs, errors;
  relievo_reload_id id;
  relievo_program* kept; /* the last one */
  int32_t line;
  char file[1024];
} told;

static void take_event(void* user, const relievo_reload_event* event) {
  told* seen = (told*)user;
  relievo_error error;
  if (event->error) {
    CHECK(event->program == NULL);
    ++seen->errors;
    seen->line = event->error->line;
    strcpy(seen->file, event->error->file);
  }
  if (event->program) {
    CHECK(event->error == NULL);
    ++seen->programs;
    relievo_program_free(seen->kept);
    seen->kept = NULL;
    OK(relievo_program_share(event->program, &seen->kept, &error));
  }
  if (event->id_count > 0) seen->id = event->ids[0];
}

static void write_file(const char* folder, const char* name, const char* text) {
  char path[1024];
  FILE* file;
  snprintf(path, sizeof path, "%s/edited/%s", folder, name);
  file = fopen(path, "w");
  CHECK(file != NULL);
  if (!file) return;
  fputs(text, file);
  fclose(file);
}

/* A technique that answers `result`; edits of one test differ in length. */
static void write_technique(const char* folder, const char* result) {
  char text[256];
  snprintf(text, sizeof text,
           "#include \"shaders/lib/interval.glsl\"\nHit edited_trace(Ray ray) {\n  return %s;\n}\n", result);
  write_file(folder, "edited.glsl", text);
}

/* Polls until the callback was told so much; files settle for a moment first. */
static void poll_until(relievo_reloader* reloader, const told* seen, size_t programs, size_t errors) {
  const time_t begin = time(NULL);
  relievo_error error;
  size_t reloaded = 0, sum = 0;
  const size_t before = seen->programs;
  while ((seen->programs < programs || seen->errors < errors) && time(NULL) - begin < 60) {
    if (!OK(relievo_reloader_poll(reloader, &reloaded, &error))) return;
    sum += reloaded;
  }
  CHECK(seen->programs == programs && seen->errors == errors && before + sum == programs);
}

static size_t fragment_size(const relievo_program* program) {
  relievo_error error;
  relievo_bytes output = {NULL, 0};
  OK(relievo_program_output(program, RELIEVO_FRAGMENT, "glsl-450", &output, &error));
  return output.size;
}

static relievo_program_desc edited_desc(void) {
  static const char* const targets[] = {"glsl-450"};
  relievo_program_desc desc;
  memset(&desc, 0, sizeof desc);
  desc.stage = "surface";
  desc.technique = "edited";
  desc.targets = targets;
  desc.target_count = 1;
  desc.skip_optimizer = 1;
  return desc;
}

static void check_edits(relievo_reloader* reloader, told* seen, const char* folder) {
  relievo_program_desc desc = edited_desc();
  relievo_program* current = NULL;
  relievo_reload_counts counts;
  relievo_reload_id id = 0;
  relievo_error error;
  size_t first;
  if (!OK(relievo_reloader_add(reloader, &desc, &id, &error))) return;
  OK(relievo_reloader_current(reloader, id, &current, &error));
  CHECK(id != 0 && current == NULL);
  poll_until(reloader, seen, 1, 0);
  CHECK(seen->id == id && seen->kept != NULL);
  if (!seen->kept) return;
  first = fragment_size(seen->kept);
  write_technique(folder, "relievo_hit_at(ray, RELIEVO_HIT, 0.25 + 0.5 * ray.t_max)");
  poll_until(reloader, seen, 2, 0);
  CHECK(fragment_size(seen->kept) > first);
  write_technique(folder, "nothing");
  poll_until(reloader, seen, 2, 1);
  CHECK(seen->line == 3 && strstr(seen->file, "edited.glsl") != NULL);
  CHECK(strncmp(seen->file, folder, strlen(folder)) == 0);
  OK(relievo_reloader_current(reloader, id, &current, &error));
  CHECK(current != NULL && fragment_size(current) == fragment_size(seen->kept)); /* the old program stays */
  relievo_program_free(current);
  OK(relievo_reloader_counts(reloader, &counts, &error));
  CHECK(counts.loads >= 2 && counts.compiled == 3 && counts.looks > counts.loads);
  OK(relievo_reloader_remove(reloader, id, &error));
  OK(relievo_reloader_current(reloader, id, &current, &error));
  CHECK(current == NULL);
  desc.stage = "nowhere";
  CHECK(relievo_reloader_add(reloader, &desc, &id, &error) == RELIEVO_ERROR_USAGE);
  CHECK(strcmp(error.id, "describe.unknown-stage") == 0);
}

void use_reloader(const char* folder) {
  relievo_reload_desc desc;
  relievo_reloader* reloader = NULL;
  relievo_error error;
  told seen;
  memset(&seen, 0, sizeof seen);
  memset(&desc, 0, sizeof desc);
  write_file(folder, "technique.toml",
             "schema = 1\nname = \"edited\"\ntitle = \"To edit\"\nsource = \"none\"\nsummary = \"None.\"\n"
             "class = \"non_iterative\"\nfirst_hit = \"never\"\nmodule = \"edited.glsl\"\nmaps = [\"height\"]\n");
  write_technique(folder, "relievo_hit_at(ray, RELIEVO_HIT, 0.5)");
  desc.folders = &folder;
  desc.folder_count = 1;
  desc.settle_ms = 1;
  desc.callback = take_event;
  desc.user = &seen;
  if (!OK(relievo_reloader_create(&desc, &reloader, &error))) return;
  check_edits(reloader, &seen, folder);
  relievo_reloader_free(reloader);
  if (seen.kept) CHECK(fragment_size(seen.kept) > 100); /* outlives the reloader */
  relievo_program_free(seen.kept);
  reloader = NULL;
  folder = "/nonexistent";
  CHECK(relievo_reloader_create(&desc, &reloader, &error) == RELIEVO_ERROR_IO && reloader == NULL);
}

/* With a thread of its own and no callback, the application asks. */
void use_reloading_thread(void) {
  const relievo_program_desc program = {.stage = "surface", .technique = "parallax"};
  const time_t begin = time(NULL);
  relievo_reload_desc desc;
  relievo_reloader* reloader = NULL;
  relievo_program* current = NULL;
  relievo_reload_id id = 0;
  relievo_error error;
  memset(&desc, 0, sizeof desc);
  desc.interval_ms = 1000;
  if (!OK(relievo_reloader_create(&desc, &reloader, &error))) return;
  OK(relievo_reloader_add(reloader, &program, &id, &error));
  while (current == NULL && time(NULL) - begin < 60) OK(relievo_reloader_current(reloader, id, &current, &error));
  CHECK(current != NULL);
  relievo_program_free(current);
  relievo_reloader_free(reloader);
}
