// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>

namespace kiln {

/// OpenGL 4.5 core context without a window, current on the thread that made it for as long as it lives.
class EglContext {
 public:
  /// `device` is "auto" (the first hardware device that gives a context, else the software renderer), "software", or
  /// the number of a device as eglQueryDevicesEXT counts. Throws WrongUsage for another text, MachineLacks where there
  /// is no such context. A software renderer uses `software_threads` threads, 0 for as many as there are cores.
  explicit EglContext(const std::string& device = "auto", int software_threads = 0);
  ~EglContext();
  EglContext(const EglContext&) = delete;
  EglContext& operator=(const EglContext&) = delete;

  /// Returns GL_RENDERER, such as "llvmpipe (LLVM 15.0.6, 256 bits)".
  const std::string& renderer() const { return renderer_; }

  /// Tells whether a CPU does the work.
  bool is_software() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
  std::string renderer_;
};

/// Tells whether EglContext(device, ...) would be a GPU's.
bool has_hardware_egl(const std::string& device);

}  // namespace kiln
