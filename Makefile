# SPDX-License-Identifier: GPL-3.0-or-later
# Kiln's front door: CMake builds the stages, `kiln` runs them on content.
#
#   make          build everything into build/release
#   make demo     build the programs, then run pipeline.yaml; ends by naming the report
#   make test     build, then run all tests
#   make check    formatting, clang-tidy, sanitizers, a build with clang; CHECKS="format tidy" for some of them
#   make extremes measure Kiln at its extremes, into docs/extremes.md: minutes, and 8 GB of memory
#   make docs     API pages of the runtime's headers and the stages' functions, by Doxygen, in build/docs
#   make install  install programs, the runtime and its headers; PREFIX=/usr/local, DESTDIR for packagers
#   make package  a .deb of the same, in build/release
#   make clean    remove what was built and made

PRESET ?= release
JOBS   ?= $(shell nproc)
BUILD  := build/$(PRESET)
PREFIX ?= /usr/local

.PHONY: build programs pages configure demo test check extremes docs install package clean

build: configure
	cmake --build $(BUILD) -j $(JOBS)

programs: configure
	cmake --build $(BUILD) -j $(JOBS) --target programs

pages: configure
	cmake --build $(BUILD) -j $(JOBS) --target programs pages

configure:
	@tools/setup $(SETUP)
	@test -f $(BUILD)/build.ninja || cmake --preset $(PRESET)

demo: programs
	$(BUILD)/bin/kiln build pipeline.yaml

test: SETUP := tests
test: build
	ctest --preset $(PRESET) -j $(JOBS)

check:
	.ci/check $(CHECKS)

extremes: programs
	cmake --build $(BUILD) -j $(JOBS) --target extremes
	$(BUILD)/bin/extremes --output docs/extremes.md

docs:
	@tools/setup docs
	@mkdir -p build/docs
	doxygen docs/Doxyfile
	@echo build/docs/html/index.html

install: pages
	cmake --install $(BUILD) --prefix $(PREFIX)

package: pages
	cd $(BUILD) && cpack

clean:
	rm -rf $(BUILD) out
