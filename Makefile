# limn: `make` builds, `make demo` shows, `make test` proves. Everything else is optional.
PRESET ?= release
BUILD := build/$(PRESET)
JOBS ?= $(shell nproc)

.PHONY: all build configure setup demo test format lint clean install

all: build

setup:
	@scripts/setup

configure: setup
	@cmake --preset $(PRESET) > $(or $(TMPDIR),/tmp)/limn-configure.log || { cat $(or $(TMPDIR),/tmp)/limn-configure.log; exit 1; }

build: configure
	@cmake --build --preset $(PRESET) --parallel $(JOBS)

demo: build
	@$(BUILD)/limn demo -o $(BUILD)/demo.png

test: build
	@ctest --preset $(PRESET) --parallel $(JOBS)

format:
	@git ls-files '*.h' '*.cpp' | xargs clang-format -i

install: build
	@cmake --install $(BUILD)

clean:
	@rm -rf build
