// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>
#include <yaml-cpp/yaml.h>

namespace kiln {

/// A YAML file of one document; refuses its nodes with file and line.
class YamlFile {
 public:
  /// Reads and parses a file. Throws BadInput for invalid YAML, for indentation by tabs, and for a second document.
  explicit YamlFile(std::filesystem::path file);

  const std::filesystem::path& file() const { return file_; }
  const YAML::Node& root() const { return root_; }

  /// Returns "FILE:LINE" of a node.
  std::string where(const YAML::Node& node) const { return where(node.Mark()); }
  std::string where(const YAML::Mark& mark) const;

  /// Throws BadInput at the node unless `good` holds.
  void require(bool good, const YAML::Node& node, const std::string& found, const std::string& expected) const;

  /// Requires a map whose keys are scalars, each there once, and each one of `known` (empty: any).
  void check_keys(const YAML::Node& map, const std::vector<std::string>& known) const;

  /// Returns the text of one value that is not empty.
  std::string scalar(const YAML::Node& node, const std::string& expected) const;

  /// Returns a finite number as it is written; nothing if there is no node.
  std::string number(const YAML::Node& node) const;

  /// Returns a path as it is written: any bytes but NUL.
  std::filesystem::path path(const YAML::Node& node) const;

 private:
  YAML::Node only_document(const std::string& text) const;
  std::filesystem::path file_;
  YAML::Node root_;
};

}  // namespace kiln
