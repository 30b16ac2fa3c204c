# Kiln's front door. CMake builds the stages, `kiln` runs them on content.
#
#   make          build everything into build/release
#   make demo     build, then run pipeline.yaml; ends by naming the report
#   make test     build, then run all tests
#   make clean    remove what was built and made

PRESET ?= release
JOBS   ?= $(shell nproc)
BUILD  := build/$(PRESET)

.PHONY: build demo test clean

build:
	@tools/setup
	@test -f $(BUILD)/build.ninja || cmake --preset $(PRESET)
	cmake --build $(BUILD) -j $(JOBS)

demo: build
	$(BUILD)/bin/kiln build pipeline.yaml

test: build
	ctest --preset $(PRESET) -j $(JOBS)

clean:
	rm -rf $(BUILD) out
