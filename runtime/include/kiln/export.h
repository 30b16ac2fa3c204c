// SPDX-License-Identifier: MIT
#pragma once

#define KILN_RUNTIME_API __attribute__((visibility("default")))
