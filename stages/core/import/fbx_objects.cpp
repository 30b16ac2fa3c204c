// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/fbx_objects.h"

namespace kiln {

namespace {

constexpr std::size_t first_property_value = 4;  // after the name, two types and flags

const FbxRecord* child_of(const FbxRecord* record, std::string_view name) {
  return record == nullptr ? nullptr : record->child(name);
}

}  // namespace

FbxProperties::FbxProperties(const FbxRecord* object, const FbxRecord* defaults)
    : own_(child_of(object, "Properties70")), defaults_(child_of(defaults, "Properties70")) {}

const FbxRecord* FbxProperties::find(std::string_view name) const {
  for (const FbxRecord* list : {own_, defaults_}) {
    if (list == nullptr) continue;
    for (const FbxRecord& property : list->children)
      if (property.text(0) == name) return &property;
  }
  return nullptr;
}

std::optional<double> FbxProperties::number(std::string_view name) const {
  const FbxRecord* property = find(name);
  return property == nullptr ? std::nullopt : property->number(first_property_value);
}

std::optional<Eigen::Vector3d> FbxProperties::vector(std::string_view name) const {
  const FbxRecord* property = find(name);
  if (property == nullptr) return std::nullopt;
  Eigen::Vector3d result;
  for (int k = 0; k < 3; ++k) {
    const auto number = property->number(first_property_value + static_cast<std::size_t>(k));
    if (!number) return std::nullopt;
    result[k] = *number;
  }
  return result;
}

std::string_view FbxProperties::text(std::string_view name) const {
  const FbxRecord* property = find(name);
  return property == nullptr ? std::string_view() : property->text(first_property_value);
}

std::string FbxObjects::Object::name() const {
  const std::string_view full = record->text(1);
  if (const std::size_t end = full.find('\0'); end != std::string_view::npos) return std::string(full.substr(0, end));
  const std::size_t colons = full.find("::");
  return std::string(colons == std::string_view::npos ? full : full.substr(colons + 2));
}

FbxObjects::FbxObjects(const FbxDocument& document) {
  if (const FbxRecord* definitions = document.root().child("Definitions"))
    for (const FbxRecord& definition : definitions->children)
      if (definition.name == "ObjectType") templates_.emplace(definition.text(0), definition.child("PropertyTemplate"));
  if (const FbxRecord* objects = document.root().child("Objects"))
    for (const FbxRecord& record : objects->children) {
      const auto id = record.whole(0);
      if (!id) continue;
      if (!number_of_.emplace(*id, objects_.size()).second)
        document.fail(
            "has two objects of the number " + std::to_string(*id) + ", the second at " + document.place_of(record),
            "numbers that are used once");
      objects_.push_back({*id, &record});
    }
  if (const FbxRecord* connections = document.root().child("Connections"))
    for (const FbxRecord& link : connections->children) {
      const auto child = link.whole(1), parent = link.whole(2);
      if (!child || !parent) continue;
      const std::string_view property = link.text(0) == "OP" ? link.text(3) : std::string_view();
      children_[*parent].push_back({*child, property});
      parents_[*child].push_back({*parent, property});
    }
}

const FbxObjects::Object* FbxObjects::find(std::int64_t id) const {
  const auto found = number_of_.find(id);
  return found == number_of_.end() ? nullptr : &objects_[found->second];
}

std::span<const FbxObjects::Link> FbxObjects::links(const Links& links, std::int64_t id) {
  const auto found = links.find(id);
  return found == links.end() ? std::span<const Link>() : std::span<const Link>(found->second);
}

std::span<const FbxObjects::Link> FbxObjects::children(std::int64_t id) const { return links(children_, id); }
std::span<const FbxObjects::Link> FbxObjects::parents(std::int64_t id) const { return links(parents_, id); }

FbxProperties FbxObjects::properties(const Object& object) const {
  const auto found = templates_.find(object.kind());
  return {object.record, found == templates_.end() ? nullptr : found->second};
}

}  // namespace kiln
