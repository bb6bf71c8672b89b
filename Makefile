# limn: `make` builds, `make demo` shows, `make test` proves. Everything else is optional.
#
#   make test PRESET=asan-ubsan    another way to build: dev, asan-ubsan, tsan, coverage (CMakePresets.json)
#   make JOBS=1                    fewer compilers at once; each wants up to 1 GB
PRESET ?= release
JOBS ?= $(shell nproc)
BUILD := build/$(PRESET)

.PHONY: all setup configure build demo test format lint models install clean help

all: build

setup:
	@scripts/setup

# What CMake says is shown only when it fails.
configure: setup
	@mkdir -p $(BUILD)
	@cmake --preset $(PRESET) > $(BUILD)/configure.log 2>&1 || { cat $(BUILD)/configure.log; exit 1; }

build: configure
	@cmake --build --preset $(PRESET) --parallel $(JOBS)

# Builds the program alone, so that a first look does not wait for the tests.
demo: configure
	@cmake --build --preset $(PRESET) --parallel $(JOBS) --target limn_cli
	@$(BUILD)/limn demo -o $(BUILD)/demo.png

test: build
	@ctest --preset $(PRESET) --parallel $(JOBS)

format:
	@scripts/format

lint: build
	@scripts/format --check
	@scripts/tidy $(BUILD)
	@echo "lint: nothing found"

models:
	@scripts/models

install: build
	@cmake --install $(BUILD)

clean:
	@rm -rf build

help:
	@sed -n '1,4s/^# \{0,1\}//p' Makefile
	@echo "targets: all demo test setup format lint models install clean"
