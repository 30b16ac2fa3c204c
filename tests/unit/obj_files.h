// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "base/errors.h"
#include "damaged_text.h"
#include "import/readers.h"
#include "scratch.h"

namespace kiln {

/// Writes OBJ files and their libraries into a folder of its own, and reads them.
class ObjFiles : public testing::Test {
 protected:
  std::filesystem::path path(const std::string& name) const { return scratch_.folder() / name; }

  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories(path(name).parent_path());
    std::ofstream(path(name), std::ios::binary) << text;
    return path(name);
  }

  SourceMesh read(const std::string& obj) const { return read_obj(write("a.obj", obj)); }

  /// Returns what read() throws, or "no error".
  std::string refusal(const std::string& obj) const {
    try {
      read(obj);
    } catch (const BadInput& error) {
      return error.what();
    }
    return "no error";
  }

 private:
  Scratch scratch_;
};

inline testing::AssertionResult says(const std::string& text, const std::vector<std::string>& parts) {
  for (const std::string& part : parts)
    if (text.find(part) == std::string::npos) return testing::AssertionFailure() << "'" << text << "' lacks " << part;
  return testing::AssertionSuccess();
}

/// Tests whether there is exactly one warning, which contains all of `parts`.
inline testing::AssertionResult warns_only(const SourceMesh& mesh, const std::vector<std::string>& parts) {
  if (mesh.warnings.size() != 1) {
    testing::AssertionResult failure = testing::AssertionFailure() << mesh.warnings.size() << " warnings:";
    for (const std::string& warning : mesh.warnings) failure << " " << warning << ";";
    return failure;
  }
  return says(mesh.warnings[0], parts);
}

}  // namespace kiln
