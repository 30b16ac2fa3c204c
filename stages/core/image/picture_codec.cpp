// SPDX-License-Identifier: MIT
#include "image/picture_codec.h"

#include <dlfcn.h>

#include "base/errors.h"

namespace kiln {

namespace {

PictureCodec& load_codec() {
  constexpr char library[] = "libkiln-openimageio.so";
  void* handle = dlopen(library, RTLD_LAZY | RTLD_LOCAL);
  void* function = handle != nullptr ? dlsym(handle, "kiln_openimageio_codec") : nullptr;
  if (function == nullptr)
    throw MachineLacks("pictures other than PNG and OpenEXR cannot be read, nor text be drawn (" +
                       std::string(dlerror()) + "); install Kiln with " + library +
                       ", and OpenImageIO (libopenimageio2.4)");
  return *reinterpret_cast<PictureCodec* (*)()>(function)();
}

}  // namespace

PictureCodec& picture_codec() {
  static PictureCodec& codec = load_codec();
  return codec;
}

}  // namespace kiln
