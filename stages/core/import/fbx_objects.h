// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "import/fbx_document.h"

namespace kiln {

/// Properties of an object ("Properties70"), with the file's template for its kind as defaults.
class FbxProperties {
 public:
  FbxProperties(const FbxRecord* object, const FbxRecord* defaults);

  std::optional<double> number(std::string_view name) const;
  std::optional<Eigen::Vector3d> vector(std::string_view name) const;
  std::string_view text(std::string_view name) const;

 private:
  const FbxRecord* find(std::string_view name) const;

  const FbxRecord* own_ = nullptr;
  const FbxRecord* defaults_ = nullptr;
};

/// Objects of an FBX file by their numbers, and the connections between them.
class FbxObjects {
 public:
  struct Object {
    std::int64_t id = 0;
    const FbxRecord* record = nullptr;

    std::string_view kind() const { return record->name; }            ///< "Model", "Geometry" and so on
    std::string_view kind_within() const { return record->text(2); }  ///< "Mesh", "Null" and so on
    std::string name() const;                                         ///< without its kind, which binary files append
  };
  struct Link {
    std::int64_t other = 0;
    std::string_view property;  ///< property of the parent; empty where the whole object is connected
  };

  explicit FbxObjects(const FbxDocument& document);

  const std::vector<Object>& all() const { return objects_; }

  /// Returns the object of that number; null where there is none.
  const Object* find(std::int64_t id) const;

  std::span<const Link> children(std::int64_t id) const;
  std::span<const Link> parents(std::int64_t id) const;

  FbxProperties properties(const Object& object) const;

 private:
  using Links = std::map<std::int64_t, std::vector<Link>>;
  static std::span<const Link> links(const Links& links, std::int64_t id);

  std::vector<Object> objects_;  ///< in the file's order
  std::map<std::int64_t, std::size_t> number_of_;
  Links children_, parents_;
  std::map<std::string_view, const FbxRecord*> templates_;  ///< by kind
};

}  // namespace kiln
