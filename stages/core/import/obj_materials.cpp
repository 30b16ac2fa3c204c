// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/obj_materials.h"

#include <algorithm>
#include <optional>

#include "base/errors.h"
#include "import/mtl_reader.h"
#include "import/named_file.h"
#include "import/text_words.h"
#include "import/wavefront_lines.h"

namespace kiln {

namespace {

namespace fs = std::filesystem;

/// Splits names of libraries: those in quotes, and words; a word that does not end in .mtl continues up to the next
/// that does.
std::vector<std::string> split_names(std::string_view text) {
  std::vector<std::string> names;
  std::string begun;
  for (text = trimmed(text); !text.empty(); text = trimmed(text)) {
    const bool is_quoted = text.front() == '"';
    const std::string name(next_name(text));
    if (name.empty()) continue;
    begun += (begun.empty() ? "" : " ") + name;
    const bool is_whole = name.size() > 4 && same_word(std::string_view(name).substr(name.size() - 4), ".mtl");
    if (!is_whole && !is_quoted) continue;
    names.push_back(std::move(begun));
    begun.clear();
  }
  if (!begun.empty()) names.push_back(std::move(begun));
  return names;
}

/// Materials of all libraries by their names; the first of a name counts.
class Libraries {
 public:
  Libraries(const fs::path& obj_file, SourceMesh& mesh) : obj_file_(obj_file), mesh_(mesh) {}

  /// Reads the libraries that a line names: one whose name may have blanks, or several.
  void read(const std::string& names, std::uint32_t line) {
    for (const std::string_view whole : {std::string_view(names), name_without_comment(names)})
      if (const auto file = find_named_file(obj_file_.parent_path(), unquoted(whole))) return read_file(*file);
    for (const std::string& name : split_names(name_without_comment(names))) {
      const auto file = find_named_file(obj_file_.parent_path(), name);
      if (!file)
        throw BadInput(
            obj_file_.string() + ":" + std::to_string(line),
            "names the material library " + (obj_file_.parent_path() / name).string() + ", which does not exist",
            "a file", "put it there, or give --albedo a number");
      read_file(*file);
    }
  }

  /// Finds the material of a name that a comment may follow; null where there is none. Names are first sought as
  /// written, since they may hold a #.
  const LibraryMaterial* find(std::string_view name) const {
    for (const std::string_view sought : {unquoted(name), unquoted(name_without_comment(name))})
      for (const auto* known : {&whole_, &without_comment_})
        if (const auto found = known->find(sought); found != known->end()) return &materials_[found->second];
    return nullptr;
  }

  void warn() const {
    if (repeated_ > 0)
      mesh_.warnings.push_back(counted(repeated_, "material") +
                               " defined again in the material libraries; the first definition of a name counts");
  }

 private:
  void read_file(const fs::path& file) {
    if (std::find(mesh_.further_files.begin(), mesh_.further_files.end(), file) != mesh_.further_files.end()) return;
    mesh_.further_files.push_back(file);
    for (LibraryMaterial& material : read_material_library(file)) {
      const std::string_view name = material.material.name;
      repeated_ += !whole_.try_emplace(std::string(unquoted(name)), materials_.size()).second;
      without_comment_.try_emplace(std::string(unquoted(name_without_comment(name))), materials_.size());
      materials_.push_back(std::move(material));
    }
  }

  fs::path obj_file_;
  SourceMesh& mesh_;
  std::vector<LibraryMaterial> materials_;
  std::map<std::string, std::size_t, std::less<>> whole_, without_comment_;
  std::size_t repeated_ = 0;
};

/// Collects warnings about materials that faces use.
class MaterialWarnings {
 public:
  void add(const LibraryMaterial& material) {
    clamped_ += material.is_clamped;
    unread_.insert(unread_.end(), material.unread_maps.begin(), material.unread_maps.end());
    for (const std::string& map : material.other_maps)
      if (std::find(maps_.begin(), maps_.end(), map) == maps_.end()) maps_.push_back(map);
  }

  void give(std::vector<std::string>& warnings) const {
    warnings.insert(warnings.end(), unread_.begin(), unread_.end());
    if (clamped_ > 0) warnings.push_back(counted(clamped_, "material") + " with a Kd outside 0 to 1, clamped to that");
    if (maps_.empty()) return;
    std::string list;
    for (const std::string& map : maps_) list += (list.empty() ? "" : ", ") + map;
    warnings.push_back("maps that are not used: " + list);
  }

 private:
  std::size_t clamped_ = 0;
  std::vector<std::string> unread_, maps_;
};

}  // namespace

std::int32_t ObjMaterials::use(std::string_view name) {
  name = trimmed(name);
  if (unquoted(name).empty() || name == "#" || name.starts_with("# ")) return -1;
  const auto found = numbers_of_.find(name);
  if (found != numbers_of_.end()) return found->second;
  numbers_of_.emplace(name, static_cast<std::int32_t>(names_.size()));
  names_.emplace_back(name);
  return static_cast<std::int32_t>(names_.size() - 1);
}

void ObjMaterials::add_library(std::string_view names, std::uint32_t line) {
  names = trimmed(names);
  const bool is_again = !libraries_.empty() && libraries_.back().names == names;
  if (!names.empty() && !is_again) libraries_.push_back({std::string(names), line});
}

void ObjMaterials::finish(const fs::path& file, SourceMesh& mesh) const {
  std::vector<bool> is_used(names_.size(), false);
  for (const SourceMesh::Face& face : mesh.faces)
    if (face.material >= 0) is_used[static_cast<std::size_t>(face.material)] = true;
  const auto used = static_cast<std::size_t>(std::count(is_used.begin(), is_used.end(), true));
  if (used == 0) return;
  std::vector<std::int32_t> number_of(names_.size(), -1);
  if (libraries_.empty()) {
    mesh.warnings.push_back("names " + counted(used, "material") +
                            ", but no material library (mtllib) that has them; they are not used");
  } else {
    try {
      number_of = read_used(file, is_used, mesh);
    } catch (const BadInput& fault) {
      mesh.materials_fault = fault;
      mesh.materials.clear();
    }
  }
  for (SourceMesh::Face& face : mesh.faces)
    if (face.material >= 0) face.material = number_of[static_cast<std::size_t>(face.material)];
}

std::vector<std::int32_t> ObjMaterials::read_used(const fs::path& file, const std::vector<bool>& is_used,
                                                  SourceMesh& mesh) const {
  Libraries libraries(file, mesh);
  for (const Library& library : libraries_) libraries.read(library.names, library.line);
  MaterialWarnings warnings;
  std::vector<std::int32_t> number_of(names_.size(), -1);
  std::map<const LibraryMaterial*, std::int32_t> numbers;
  for (std::size_t k = 0; k < names_.size(); ++k) {
    if (!is_used[k]) continue;
    const LibraryMaterial* const material = libraries.find(names_[k]);
    if (material == nullptr && name_without_comment(names_[k]).empty()) continue;
    if (material == nullptr)
      throw BadInput(file.string(), "uses the material " + shown(unquoted(names_[k])),
                     "one that its material library has", "export the materials again, or give --albedo a number");
    if (material->fault) throw BadInput(*material->fault);
    const auto [found, inserted] = numbers.try_emplace(material, static_cast<std::int32_t>(mesh.materials.size()));
    number_of[k] = found->second;
    if (!inserted) continue;
    mesh.materials.push_back(material->material);
    mesh.materials.back().name = unquoted(name_without_comment(names_[k]));
    warnings.add(*material);
  }
  libraries.warn();
  warnings.give(mesh.warnings);
  return number_of;
}

}  // namespace kiln
