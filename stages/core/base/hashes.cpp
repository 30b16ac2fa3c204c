// SPDX-License-Identifier: MIT
#include "base/hashes.h"

#include <fstream>
#include <new>
#include <xxhash.h>

#include "base/errors.h"

namespace kiln {

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

std::string hash_file(const std::filesystem::path& file) {
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
