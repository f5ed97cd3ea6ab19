#include "c_api/registry.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <memory>

#include "c_api/boundary.hpp"
#include "describe/description.hpp"

namespace relievo::c_api {

static_assert(RELIEVO_MACRO == static_cast<int>(BindingTime::macro));
static_assert(RELIEVO_SPECIALIZATION == static_cast<int>(BindingTime::specialization));
static_assert(RELIEVO_UNIFORM == static_cast<int>(BindingTime::uniform));

namespace {

using Item = relievo_registry::Item;

constexpr std::int32_t kind_count = 3;

template <class Descriptors>
void add_items(const Descriptors& descriptors, std::vector<Item>& items) {
  for (const auto& [name, d] : descriptors)
    items.push_back({d.name, d.title, d.source, d.summary, description_of(d).dump(2), &d.parameters});
}

Status check(const relievo_registry* registry, relievo_kind kind, std::initializer_list<Argument> others) {
  if (Status status = require({{"registry", registry}}); !status) return status;
  if (Status status = require(others); !status) return status;
  return require_enum("kind", kind, kind_count);
}

/// The error for an unknown name is the registry's own.
Result<const Item*> find(const relievo_registry& registry, relievo_kind kind, const char* name) {
  Status known;
  const auto look_up = [&](const auto& found) {
    if (!found) known = tl::unexpected(found.error());
  };
  if (kind == RELIEVO_TECHNIQUE) look_up(registry.registry.technique(name));
  if (kind == RELIEVO_STAGE) look_up(registry.registry.stage(name));
  if (kind == RELIEVO_MAP) look_up(registry.registry.map(name));
  if (!known) return tl::unexpected(known.error());
  const auto& items = registry.items[kind];
  return &*std::find_if(items.begin(), items.end(), [&](const Item& item) { return item.name == name; });
}

relievo_description describe(const Item& item) {
  return {view(item.name),    view(item.title), view(item.source),
          view(item.summary), view(item.json),  item.parameters->size()};
}

relievo_parameter describe(const Parameter& parameter) {
  return {view(parameter.name),
          view(parameter.title),
          view(parameter.unit),
          parameter.minimum,
          parameter.maximum,
          parameter.value,
          static_cast<relievo_binding_time>(parameter.binding),
          parameter.is_integer,
          parameter.is_loop};
}

std::vector<std::string> parameter_names(const relievo_registry& registry) {
  std::vector<std::string> names;
  for (const auto& items : registry.items) {
    for (const Item& item : items) {
      for (const Parameter& parameter : *item.parameters) names.push_back(item.name + "." + parameter.name);
    }
  }
  return names;
}

}  // namespace

Result<std::map<std::string, double>> values_of(const relievo_registry& registry, const relievo_value* values,
                                                std::size_t count) {
  Result<std::map<std::string, double>> by_name = values_of(values, count);
  if (!by_name || by_name->empty()) return by_name;
  const std::vector<std::string> known = parameter_names(registry);
  for (const auto& [name, value] : *by_name) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    const std::string nearest = nearest_name(name, known);
    return fail(ErrorCode::usage, "c.parameter",
                fmt::format("'{}' is no parameter{}", name,
                            nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest)));
  }
  return by_name;
}

}  // namespace relievo::c_api

using namespace relievo;
using namespace relievo::c_api;

relievo_status relievo_registry_load(const char* const* folders, size_t folder_count, relievo_registry** registry,
                                     relievo_error* error) {
  return at_boundary(error, [&]() -> Status {
    if (Status status = require({{"registry", registry}}); !status) return status;
    const Result<std::vector<std::string>> paths = texts_of("folders", folders, folder_count);
    if (!paths) return tl::unexpected(paths.error());
    Result<Registry> loaded = load_registry(std::vector<std::filesystem::path>(paths->begin(), paths->end()));
    if (!loaded) return tl::unexpected(loaded.error());
    auto handle = std::make_unique<relievo_registry>();
    handle->registry = *std::move(loaded);
    add_items(handle->registry.techniques, handle->items[RELIEVO_TECHNIQUE]);
    add_items(handle->registry.stages, handle->items[RELIEVO_STAGE]);
    add_items(handle->registry.maps, handle->items[RELIEVO_MAP]);
    *registry = handle.release();
    return {};
  });
}

void relievo_registry_free(relievo_registry* registry) {
  delete registry;
}

relievo_status relievo_registry_count(const relievo_registry* registry, relievo_kind kind, size_t* count,
                                      relievo_error* error) {
  return at_boundary(error, [&]() -> Status {
    if (Status status = check(registry, kind, {{"count", count}}); !status) return status;
    *count = registry->items[kind].size();
    return {};
  });
}

relievo_status relievo_registry_at(const relievo_registry* registry, relievo_kind kind, size_t index,
                                   relievo_description* description, relievo_error* error) {
  return at_boundary(error, [&]() -> Status {
    if (Status status = check(registry, kind, {{"description", description}}); !status) return status;
    const auto& items = registry->items[kind];
    if (Status status = require_index(index, items.size()); !status) return status;
    *description = describe(items[index]);
    return {};
  });
}

relievo_status relievo_registry_find(const relievo_registry* registry, relievo_kind kind, const char* name,
                                     relievo_description* description, relievo_error* error) {
  return at_boundary(error, [&]() -> Status {
    if (Status status = check(registry, kind, {{"name", name}, {"description", description}}); !status) return status;
    const Result<const Item*> item = find(*registry, kind, name);
    if (!item) return tl::unexpected(item.error());
    *description = describe(**item);
    return {};
  });
}

relievo_status relievo_registry_parameter(const relievo_registry* registry, relievo_kind kind, const char* name,
                                          size_t index, relievo_parameter* parameter, relievo_error* error) {
  return at_boundary(error, [&]() -> Status {
    if (Status status = check(registry, kind, {{"name", name}, {"parameter", parameter}}); !status) return status;
    const Result<const Item*> item = find(*registry, kind, name);
    if (!item) return tl::unexpected(item.error());
    if (Status status = require_index(index, (*item)->parameters->size()); !status) return status;
    *parameter = describe((*(*item)->parameters)[index]);
    return {};
  });
}
