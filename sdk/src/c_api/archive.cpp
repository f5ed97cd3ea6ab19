#include "relievo/archive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <memory>

#include "c_api/boundary.hpp"

struct relievo_archive {
  relievo::Archive archive;
  std::vector<std::string> targets;
};

namespace relievo::c_api {

namespace {

Status require_entry(const relievo_archive* archive, relievo_entry entry, std::initializer_list<Argument> others) {
  if (Status status = require({{"archive", archive}}); !status) return status;
  if (Status status = require(others); !status) return status;
  if (entry < archive->archive.size()) return {};
  return fail(ErrorCode::usage, "archive.entry",
              fmt::format("the entry is {}; one below {} is expected", entry, archive->archive.size()));
}

using Assignment = std::vector<std::pair<std::string_view, std::string_view>>;

Result<Assignment> assignment_of(const relievo_assignment* list, std::size_t count) {
  if (Status status = require_list("assignment", list, count); !status) return tl::unexpected(status.error());
  Assignment assignment;
  for (std::size_t i = 0; i < count; ++i) {
    if (Status status = require({{"assignment.axis", list[i].axis}, {"assignment.value", list[i].value}}); !status)
      return tl::unexpected(status.error());
    assignment.emplace_back(list[i].axis, list[i].value);
  }
  return assignment;
}

relievo_bytes bytes_of(std::string_view text) {
  return {text.data(), text.size()};
}

/// A result that is a view into the archive.
template <class Get>
relievo_status text_of(const relievo_archive* archive, relievo_entry entry, relievo_bytes* result, relievo_error* error,
                       const Get& get) {
  return at_boundary(error, [&]() -> Status {
    if (Status status = require_entry(archive, entry, {{"json", result}}); !status) return status;
    const Result<std::string_view> text = get();
    if (!text) return tl::unexpected(text.error());
    *result = bytes_of(*text);
    return {};
  });
}

template <class Value, class Get>
relievo_status value(const relievo_archive* archive, Value* result, relievo_error* error, const Get& get) {
  return at_boundary(error, [&]() -> Status {
    if (Status status = require({{"archive", archive}, {"result", result}}); !status) return status;
    return get();
  });
}

/// The archive's own copy of a target's name.
relievo_string name_of(const relievo_archive& archive, const Target& target) {
  const auto& targets = archive.archive.targets();
  const auto found = std::find(targets.begin(), targets.end(), target);
  return view(archive.targets[static_cast<std::size_t>(found - targets.begin())]);
}

void copy_name(std::string_view name, char* buffer, std::size_t capacity) {
  if (capacity == 0) return;
  const std::size_t size = std::min(name.size(), capacity - 1);
  std::memcpy(buffer, name.data(), size);
  buffer[size] = '\0';
}

}  // namespace

}  // namespace relievo::c_api

using namespace relievo;
using namespace relievo::c_api;

relievo_status relievo_archive_open(const char* path, relievo_archive** archive, relievo_error* error) {
  return at_boundary(error, [&]() -> Status {
    if (Status status = require({{"path", path}, {"archive", archive}}); !status) return status;
    Result<Archive> opened = Archive::open(path);
    if (!opened) return tl::unexpected(opened.error());
    auto handle = std::make_unique<relievo_archive>(relievo_archive{*std::move(opened), {}});
    for (const Target& target : handle->archive.targets()) handle->targets.push_back(to_string(target));
    *archive = handle.release();
    return {};
  });
}

void relievo_archive_free(relievo_archive* archive) {
  delete archive;
}

relievo_status relievo_archive_counts(const relievo_archive* archive, size_t* permutations, size_t* programs,
                                      relievo_error* error) {
  return at_boundary(error, [&]() -> Status {
    if (Status status = require({{"archive", archive}, {"permutations", permutations}, {"programs", programs}});
        !status)
      return status;
    *permutations = archive->archive.size();
    *programs = archive->archive.program_count();
    return {};
  });
}

relievo_status relievo_archive_axis_count(const relievo_archive* archive, size_t* count, relievo_error* error) {
  return value(archive, count, error, [&]() -> Status {
    *count = archive->archive.axes().size();
    return {};
  });
}

relievo_status relievo_archive_axis(const relievo_archive* archive, size_t index, relievo_axis* axis,
                                    relievo_error* error) {
  return value(archive, axis, error, [&]() -> Status {
    const auto& axes = archive->archive.axes();
    if (Status status = require_index(index, axes.size()); !status) return status;
    *axis = {view(axes[index].name), axes[index].values.size(), axes[index].default_value};
    return {};
  });
}

relievo_status relievo_archive_axis_value(const relievo_archive* archive, size_t axis, size_t index,
                                          relievo_string* value, relievo_error* error) {
  return c_api::value(archive, value, error, [&]() -> Status {
    const auto& axes = archive->archive.axes();
    if (Status status = require_index(axis, axes.size()); !status) return status;
    if (Status status = require_index(index, axes[axis].values.size()); !status) return status;
    *value = view(axes[axis].values[index]);
    return {};
  });
}

relievo_status relievo_archive_target_count(const relievo_archive* archive, size_t* count, relievo_error* error) {
  return value(archive, count, error, [&]() -> Status {
    *count = archive->targets.size();
    return {};
  });
}

relievo_status relievo_archive_target(const relievo_archive* archive, size_t index, relievo_string* target,
                                      relievo_error* error) {
  return value(archive, target, error, [&]() -> Status {
    if (Status status = require_index(index, archive->targets.size()); !status) return status;
    *target = view(archive->targets[index]);
    return {};
  });
}

relievo_status relievo_archive_key(const relievo_archive* archive, const relievo_assignment* assignment, size_t count,
                                   uint64_t* key, relievo_error* error) {
  return value(archive, key, error, [&]() -> Status {
    const Result<Assignment> given = assignment_of(assignment, count);
    if (!given) return tl::unexpected(given.error());
    *key = archive->archive.key(*given);
    return {};
  });
}

relievo_status relievo_archive_find_key(const relievo_archive* archive, uint64_t key, relievo_entry* entry,
                                        relievo_error* error) {
  return value(archive, entry, error, [&]() -> Status {
    const std::optional<Archive::Entry> found = archive->archive.find(key);
    if (!found) {
      return fail(ErrorCode::usage, "archive.missing",
                  fmt::format("no permutation of the archive has the key {:016x}; find it by its names to see which "
                              "are the nearest of the {} that there are",
                              key, archive->archive.size()));
    }
    *entry = *found;
    return {};
  });
}

relievo_status relievo_archive_find(const relievo_archive* archive, const relievo_assignment* assignment, size_t count,
                                    relievo_entry* entry, relievo_error* error) {
  return value(archive, entry, error, [&]() -> Status {
    const Result<Assignment> given = assignment_of(assignment, count);
    if (!given) return tl::unexpected(given.error());
    const Result<Archive::Entry> found = archive->archive.find(*given);
    if (!found) return tl::unexpected(found.error());
    *entry = *found;
    return {};
  });
}

relievo_status relievo_archive_entry(const relievo_archive* archive, relievo_entry entry, uint64_t* key,
                                     uint32_t* program, relievo_error* error) {
  return at_boundary(error, [&]() -> Status {
    if (Status status = require_entry(archive, entry, {{"key", key}, {"program", program}}); !status) return status;
    *key = archive->archive.key(entry);
    *program = archive->archive.program(entry);
    return {};
  });
}

relievo_status relievo_archive_entry_name(const relievo_archive* archive, relievo_entry entry, char* buffer,
                                          size_t capacity, size_t* size, relievo_error* error) {
  return at_boundary(error, [&]() -> Status {
    if (Status status = require_entry(archive, entry, {{"size", size}}); !status) return status;
    if (Status status = require_list("buffer", buffer, capacity); !status) return status;
    const std::string name = archive->archive.name(entry);
    copy_name(name, buffer, capacity);
    *size = name.size();
    return {};
  });
}

relievo_status relievo_archive_outputs(const relievo_archive* archive, relievo_entry entry, relievo_output* outputs,
                                       size_t capacity, size_t* count, relievo_error* error) {
  return at_boundary(error, [&]() -> Status {
    if (Status status = require_entry(archive, entry, {{"count", count}}); !status) return status;
    if (Status status = require_list("outputs", outputs, capacity); !status) return status;
    const std::vector<ArchiveOutput> all = archive->archive.outputs(entry);
    for (std::size_t i = 0; i < std::min(capacity, all.size()); ++i)
      outputs[i] = {static_cast<relievo_shader_stage>(all[i].stage), name_of(*archive, all[i].target), all[i].size};
    *count = all.size();
    return {};
  });
}

relievo_status relievo_archive_output(const relievo_archive* archive, relievo_entry entry, relievo_shader_stage stage,
                                      const char* target, relievo_bytes* output, relievo_error* error) {
  return at_boundary(error, [&]() -> Status {
    if (Status status = require_entry(archive, entry, {{"target", target}, {"output", output}}); !status) return status;
    if (Status status = require_enum("stage", stage, RELIEVO_COMPUTE + 1); !status) return status;
    const Result<Target> parsed = parse_target(target);
    if (!parsed) return tl::unexpected(parsed.error());
    const auto found = archive->archive.output(entry, static_cast<ShaderStage>(stage), *parsed);
    if (!found) return tl::unexpected(found.error());
    *output = bytes_of(*found);
    return {};
  });
}

relievo_status relievo_archive_reflection(const relievo_archive* archive, relievo_entry entry, relievo_bytes* json,
                                          relievo_error* error) {
  return text_of(archive, entry, json, error, [&] { return archive->archive.reflection(entry); });
}

relievo_status relievo_archive_cost(const relievo_archive* archive, relievo_entry entry, relievo_bytes* json,
                                    relievo_error* error) {
  return text_of(archive, entry, json, error, [&] { return archive->archive.cost(entry); });
}

relievo_status relievo_archive_verify(const relievo_archive* archive, relievo_error* error) {
  return at_boundary(error, [&]() -> Status {
    if (Status status = require({{"archive", archive}}); !status) return status;
    return archive->archive.verify();
  });
}
