# Kiln's front door. CMake builds the stages, `kiln` runs them on content.
#
#   make          build everything into build/release
#   make demo     build the programs, then run pipeline.yaml; ends by naming the report
#   make test     build, then run all tests
#   make clean    remove what was built and made

PRESET ?= release
JOBS   ?= $(shell nproc)
BUILD  := build/$(PRESET)

.PHONY: build programs configure demo test clean

build: configure
	cmake --build $(BUILD) -j $(JOBS)

programs: configure
	cmake --build $(BUILD) -j $(JOBS) --target programs

configure:
	@tools/setup
	@test -f $(BUILD)/build.ninja || cmake --preset $(PRESET)

demo: programs
	$(BUILD)/bin/kiln build pipeline.yaml

test: build
	ctest --preset $(PRESET) -j $(JOBS)

clean:
	rm -rf $(BUILD) out
