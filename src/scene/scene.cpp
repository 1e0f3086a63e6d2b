#include "bernal/scene/scene.hpp"

namespace bernal {
namespace {

const Value& value_of(const Spec& spec, std::string_view key) {
  const auto found = spec.parameters.find(key);
  if (found == spec.parameters.end())
    throw Error(ErrorCode::bad_argument, "\"" + spec.name + "\" has no \"" + std::string(key) + "\"",
                spec.where);
  return found->second.value;
}

template <class T>
const T& value_as(const Spec& spec, std::string_view key, std::string_view type) {
  if (const T* value = std::get_if<T>(&value_of(spec, key))) return *value;
  throw Error(ErrorCode::bad_argument,
              "\"" + std::string(key) + "\" of \"" + spec.name + "\" must be " + std::string(type),
              spec.location(key));
}

}  // namespace

double Spec::number(std::string_view key) const {
  if (const auto* whole = std::get_if<std::int64_t>(&value_of(*this, key)))
    return static_cast<double>(*whole);
  return value_as<double>(*this, key, "a number");
}

std::int64_t Spec::integer(std::string_view key) const {
  return value_as<std::int64_t>(*this, key, "a whole number");
}

bool Spec::flag(std::string_view key) const { return value_as<bool>(*this, key, "true or false"); }

const std::string& Spec::text(std::string_view key) const {
  return value_as<std::string>(*this, key, "text");
}

const std::vector<double>& Spec::numbers(std::string_view key) const {
  return value_as<std::vector<double>>(*this, key, "an array of numbers");
}

Location Spec::location(std::string_view key) const {
  const auto found = parameters.find(key);
  return found == parameters.end() ? where : found->second.where;
}

}  // namespace bernal
