#include "timers.hpp"

namespace relievo::opengl {
namespace {

QueryHandle timestamp() {
  GLuint name = 0;
  glCreateQueries(GL_TIMESTAMP, 1, &name);
  glQueryCounter(name, GL_TIMESTAMP);
  return QueryHandle(name);
}

GLuint64 nanoseconds(const QueryHandle& query) {
  GLuint64 value = 0;
  glGetQueryObjectui64v(query.get(), GL_QUERY_RESULT, &value);
  return value;
}

}  // namespace

void CommandTimers::begin_command() {
  if (enabled_) queries_.emplace_back(timestamp(), QueryHandle());
}

void CommandTimers::end_command() {
  if (enabled_) queries_.back().second = timestamp();
}

std::vector<double> CommandTimers::seconds() const {
  std::vector<double> result;
  for (const auto& [begin, end] : queries_) {
    const GLuint64 from = nanoseconds(begin), to = nanoseconds(end);
    result.push_back(to > from ? static_cast<double>(to - from) * 1e-9 : 0.0);
  }
  return result;
}

}  // namespace relievo::opengl
