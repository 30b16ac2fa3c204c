// SPDX-License-Identifier: MIT
#include "base/outputs.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <new>
#include <sys/statvfs.h>
#include <system_error>
#include <unistd.h>
#include <xxhash.h>

#include "base/errors.h"

namespace kiln {

namespace fs = std::filesystem;

bool disk_is_full(const fs::path& path) {
  constexpr unsigned long long least_bytes = 4096;
  std::error_code error;
  fs::path place = fs::absolute(path, error);
  while (!place.empty() && !fs::exists(place, error) && place != place.parent_path()) place = place.parent_path();
  struct statvfs disk = {};
  if (statvfs(place.c_str(), &disk) != 0 || disk.f_blocks == 0) return false;
  const auto blocks = geteuid() == 0 ? disk.f_bfree : disk.f_bavail;  // some are kept for root
  return static_cast<unsigned long long>(blocks) * disk.f_frsize < least_bytes;
}

void fail_to_write(const fs::path& path, const std::string& reason, int error_number) {
  if (error_number == ENOSPC || error_number == EDQUOT || disk_is_full(path))
    throw DiskFull(path.string() + ": cannot be written, the disk is full; free some room, or choose another output");
  throw BadInput(path.string(), "cannot be written" + (reason.empty() ? "" : " (" + reason + ")"),
                 "a place that can be written", "choose another output or change its permissions");
}

OutputSet::OutputSet(fs::path folder) : folder_(std::move(folder)) {
  std::error_code error;
  for (fs::path part = fs::absolute(folder_).lexically_normal(); !part.empty() && !fs::exists(part, error);
       part = part.parent_path())
    made_folders_.push_back(part);
  if (!fs::is_directory(folder_, error)) fs::create_directories(folder_, error);
  if (error) fail_to_write(folder_, error.message(), error.value());
  if (!fs::is_directory(folder_, error)) fail_to_write(folder_, "it is not a folder");
  std::string pattern = (folder_ / ".kiln-XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) fail_to_write(folder_, std::strerror(errno), errno);
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
  errno = 0;
  std::ofstream stream(add(name), std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) fail_to_write(folder_ / name, std::strerror(errno), errno);
}

void OutputSet::remove_stale(const std::string& name) { stale_.push_back(name); }

void OutputSet::commit() {
  if (disk_is_full(staging_)) fail_to_write(folder_ / (names_.empty() ? "" : names_.back()), "", ENOSPC);
  std::error_code error;
  for (const std::string& name : names_)
    if (fs::is_directory(folder_ / name, error)) fail_to_write(folder_ / name, "it is a folder");
  for (const std::string& name : names_) {
    fs::rename(staging_ / name, folder_ / name, error);
    if (error) fail_to_write(folder_ / name, error.message(), error.value());
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
  std::ifstream stream(file, std::ios::binary);
  XXH3_state_t* state = XXH3_createState();
  if (state == nullptr) throw std::bad_alloc();
  XXH3_128bits_reset(state);
  std::vector<char> bytes(1 << 20);
  while (stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size())), stream.gcount() > 0)
    XXH3_128bits_update(state, bytes.data(), static_cast<std::size_t>(stream.gcount()));
  const XXH128_hash_t hash = XXH3_128bits_digest(state);
  XXH3_freeState(state);
  if (!stream.eof() || stream.bad())
    throw BadInput(file.string(), "cannot be read", "a readable file", "check the path and its permissions");
  return hexadecimal(hash);
}

}  // namespace kiln
