// SPDX-License-Identifier: MIT
#pragma once

#include <exception>
#include <new>
#include <utility>

#include "base/errors.h"
#include "kiln/error.h"

namespace kiln::runtime {

/// Calls `work`, and rethrows as Error what core throws about a fault of the caller or of a file. Lack of memory stays
/// std::bad_alloc.
template <class Work>
decltype(auto) report_errors(const Work& work) {
  try {
    return work();
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    throw Error(error.what());
  }
}

}  // namespace kiln::runtime
