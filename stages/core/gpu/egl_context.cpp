// SPDX-License-Identifier: MIT
#include "gpu/egl_context.h"

#include <epoxy/gl.h>

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <cstring>
#include <string_view>
#include <vector>

#include "base/errors.h"

namespace kiln {

namespace {

constexpr int most_devices = 64;

bool has_word(const char* words, std::string_view word) {
  return words != nullptr && (" " + std::string(words) + " ").find(" " + std::string(word) + " ") != std::string::npos;
}

template <class Function>
Function egl_function(const char* name) {
  return reinterpret_cast<Function>(eglGetProcAddress(name));
}

struct Candidate {
  EGLDisplay display = EGL_NO_DISPLAY;
  bool software = false;
};

/// Lists the displays to try for `device`, best first.
std::vector<Candidate> candidates(const std::string& device) {
  std::vector<Candidate> found;
  const char* client = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  const auto get_display = egl_function<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");
  if (get_display == nullptr)
    throw MachineLacks("EGL has no platform displays (EGL_EXT_platform_base); install libegl-mesa0 or a GPU driver");

  const bool any = device == "auto";
  const bool number =
      !device.empty() && std::all_of(device.begin(), device.end(), [](unsigned char c) { return std::isdigit(c); });
  if (!any && !number && device != "software")
    throw WrongUsage("gl-device: found '" + device + "'; expected auto, software or the number of a device");

  if ((any || number) && has_word(client, "EGL_EXT_platform_device")) {
    const auto query_devices = egl_function<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
    const auto query_string = egl_function<PFNEGLQUERYDEVICESTRINGEXTPROC>("eglQueryDeviceStringEXT");
    EGLDeviceEXT devices[most_devices];
    EGLint count = 0;
    if (query_devices != nullptr && query_devices(most_devices, devices, &count) == EGL_TRUE)
      for (EGLint i = 0; i < count; ++i) {
        if (number && device != std::to_string(i)) continue;
        const bool software =
            query_string != nullptr && has_word(query_string(devices[i], EGL_EXTENSIONS), "EGL_MESA_device_software");
        if (any && software) continue;
        found.push_back({get_display(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr), software});
      }
    if (number && found.empty())
      throw MachineLacks("there is no GL device " + device + ", only " + std::to_string(count) +
                         " of them, counted from 0");
  }
  // Mesa's surfaceless platform: a GPU that answers here is one that Mesa drives.
  if (!number && has_word(client, "EGL_MESA_platform_surfaceless"))
    found.push_back({get_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr), true});
  return found;
}

}  // namespace

struct EglContext::Implementation {
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLContext context = EGL_NO_CONTEXT;

  bool create(EGLDisplay wanted) {
    display = wanted;
    if (display == EGL_NO_DISPLAY || eglInitialize(display, nullptr, nullptr) != EGL_TRUE) return false;
    eglBindAPI(EGL_OPENGL_API);
    const EGLint config_attributes[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT,
                                        EGL_NONE};
    EGLConfig config = nullptr;
    EGLint configs = 0;
    if (eglChooseConfig(display, config_attributes, &config, 1, &configs) != EGL_TRUE || configs == 0) config = nullptr;
    const EGLint context_attributes[] = {
        EGL_CONTEXT_MAJOR_VERSION,           4,       EGL_CONTEXT_MINOR_VERSION, 5, EGL_CONTEXT_OPENGL_PROFILE_MASK,
        EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
    context = eglCreateContext(display, config, EGL_NO_CONTEXT, context_attributes);
    return context != EGL_NO_CONTEXT && eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context) == EGL_TRUE;
  }

  ~Implementation() {
    if (context == EGL_NO_CONTEXT) return;
    eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display, context);
  }
};

EglContext::EglContext(const std::string& device, int software_threads) {
  // llvmpipe reads its thread count from the environment, once.
  if (software_threads > 0) setenv("LP_NUM_THREADS", std::to_string(software_threads).c_str(), 0);
  for (const Candidate& candidate : candidates(device)) {
    implementation_ = std::make_unique<Implementation>();
    if (!implementation_->create(candidate.display)) continue;
    renderer_ = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
    return;
  }
  throw MachineLacks("no OpenGL 4.5 core context through EGL (device " + device +
                     "); install libegl-mesa0 and libgl1-mesa-dri, or a GPU driver with EGL");
}

EglContext::~EglContext() = default;

bool EglContext::is_software() const {
  for (const char* name : {"llvmpipe", "softpipe", "swrast", "SwiftShader", "Software"})
    if (renderer_.find(name) != std::string::npos) return true;
  return false;
}

bool has_hardware_egl(const std::string& device) {
  try {
    return !EglContext(device, 0).is_software();
  } catch (const MachineLacks&) {
    return false;
  }
}

}  // namespace kiln
