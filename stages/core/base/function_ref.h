// SPDX-License-Identifier: MIT
#pragma once

#include <type_traits>
#include <utility>

namespace kiln {

/// Reference to an object that can be called, for arguments of functions: it costs two pointers and allocates nothing,
/// and the object must outlive it.
template <class Signature>
class FunctionRef;

template <class Result, class... Arguments>
class FunctionRef<Result(Arguments...)> {
 public:
  template <class Callable>
  FunctionRef(const Callable& callable)  // NOLINT: callers pass a lambda
      : object_(&callable), call_([](const void* object, Arguments... arguments) -> Result {
          return (*static_cast<const Callable*>(object))(std::forward<Arguments>(arguments)...);
        }) {
    static_assert(std::is_object_v<Callable>);
  }
  FunctionRef(const FunctionRef&) = default;

  Result operator()(Arguments... arguments) const { return call_(object_, std::forward<Arguments>(arguments)...); }

 private:
  const void* object_;
  Result (*call_)(const void*, Arguments...);
};

}  // namespace kiln
