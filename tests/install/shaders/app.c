/* Opens the archive that its build made, and finds a shader of the project's own technique. */
#include <relievo.h>
#include <stdio.h>

int main(void) {
  const relievo_assignment wanted[] = {{"technique", "wavy"}, {"address", "clamp"}};
  relievo_archive* archive = NULL;
  relievo_entry entry = 0;
  relievo_bytes text = {NULL, 0};
  relievo_error error = {0};
  if (relievo_archive_open(ARCHIVE, &archive, &error) == RELIEVO_OK &&
      relievo_archive_find(archive, wanted, 2, &entry, &error) == RELIEVO_OK)
    relievo_archive_output(archive, entry, RELIEVO_FRAGMENT, "glsl-450", &text, &error);
  relievo_archive_free(archive);
  printf("%s %u bytes\n", error.message, (unsigned)text.size);
  return text.size > 0 ? 0 : 1;
}
