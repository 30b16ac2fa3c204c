#include "base/outputs.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <new>
#include <system_error>
#include <unistd.h>
#include <xxhash.h>

#include "base/errors.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

BadInput cannot_write(const fs::path& path, const std::string& reason) {
  return BadInput(path.string(), "cannot be written (" + reason + ")", "a folder that can be written",
                  "choose another output or change its permissions");
}

}  // namespace

OutputSet::OutputSet(fs::path folder) : folder_(std::move(folder)) {
  std::error_code error;
  for (fs::path part = fs::absolute(folder_).lexically_normal(); !part.empty() && !fs::exists(part, error);
       part = part.parent_path())
    made_folders_.push_back(part);
  if (!fs::is_directory(folder_, error)) fs::create_directories(folder_, error);
  if (error) throw cannot_write(folder_, error.message());
  if (!fs::is_directory(folder_, error)) throw cannot_write(folder_, "it is not a folder");
  std::string pattern = (folder_ / ".kiln-XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) throw cannot_write(folder_, std::strerror(errno));
  staging_ = pattern;
}

OutputSet::~OutputSet() {
  std::error_code ignored;
  fs::remove_all(staging_, ignored);
  if (!committed_)
    for (const fs::path& made : made_folders_) fs::remove(made, ignored);  // only where empty
}

fs::path OutputSet::add(const std::string& name) {
  names_.push_back(name);
  return staging_ / name;
}

void OutputSet::add_text(const std::string& name, const std::string& text) {
  std::ofstream stream(add(name), std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) throw cannot_write(folder_ / name, std::strerror(errno));
}

void OutputSet::remove_stale(const std::string& name) { stale_.push_back(name); }

void OutputSet::commit() {
  std::error_code error;
  for (const std::string& name : names_)
    if (fs::is_directory(folder_ / name, error)) throw cannot_write(folder_ / name, "it is a folder");
  for (const std::string& name : names_) {
    fs::rename(staging_ / name, folder_ / name, error);
    if (error) throw cannot_write(folder_ / name, error.message());
  }
  for (const std::string& name : stale_) fs::remove(folder_ / name, error);
  committed_ = true;
}

fs::path folder_of(const fs::path& file) {
  const fs::path parent = file.parent_path();
  return parent.empty() ? fs::path(".") : parent;
}

std::string read_text(const fs::path& file) {
  const auto fail = [&](const std::string& found) {
    return BadInput(file.string(), found, "a readable file", "check the path and its permissions");
  };
  if (!fs::exists(file)) throw fail("does not exist");
  if (fs::is_directory(file)) throw fail("is a folder");
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw fail(std::string("cannot be opened (") + std::strerror(errno) + ")");
  std::error_code no_size;  // a pipe has none
  const auto size = fs::file_size(file, no_size);
  std::string text(no_size ? 0 : size, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(stream.gcount()));
  if (stream) text.append(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
  if (stream.bad()) throw fail("cannot be read to its end");
  return text;
}

namespace {

std::string hexadecimal(const XXH128_hash_t& hash) {
  XXH128_canonical_t canonical;
  XXH128_canonicalFromHash(&canonical, hash);
  std::string text;
  for (unsigned char byte : canonical.digest) {
    constexpr char digits[] = "0123456789abcdef";
    text += digits[byte >> 4];
    text += digits[byte & 15];
  }
  return text;
}

}  // namespace

std::string hash_bytes(const std::vector<std::span<const std::byte>>& parts) {
  XXH3_state_t* state = XXH3_createState();
  if (state == nullptr) throw std::bad_alloc();
  XXH3_128bits_reset(state);
  for (const std::span<const std::byte>& part : parts) XXH3_128bits_update(state, part.data(), part.size());
  const XXH128_hash_t hash = XXH3_128bits_digest(state);
  XXH3_freeState(state);
  return hexadecimal(hash);
}

std::string hash_file(const fs::path& file) {
  const std::string bytes = read_text(file);
  return hexadecimal(XXH3_128bits(bytes.data(), bytes.size()));
}

}  // namespace kiln
