// An OpenGL 3.3 core context without a window, over EGL. Tries a hardware device, then a software device, then Mesa's
// surfaceless platform, so the same program runs with and without a GPU or a display.
#pragma once

#include <memory>
#include <string>

#include "protocol/vocabulary/result.hpp"

namespace counterpart {

class GlContext {
 public:
  // Fails with ErrorCode::unavailable and a sentence naming what each way said.
  [[nodiscard]] static Result<std::unique_ptr<GlContext>> create();
  GlContext(const GlContext&) = delete;
  GlContext& operator=(const GlContext&) = delete;
  ~GlContext();

  // OpenGL calls of this thread go to this context from now on.
  void make_current() const;

  // For logs: how it was reached and what draws, e.g. "software device: llvmpipe (LLVM 15.0.6, 256 bits)".
  const std::string& description() const { return description_; }

 private:
  GlContext(void* display, void* context) : display_(display), context_(context) {}

  void* display_;
  void* context_;
  std::string description_;
};

}  // namespace counterpart
