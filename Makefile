# Installs what is missing, then calls the CMake presets.
PRESET ?= release
RESULTS ?= results
# Models that are no part of the project; experiments without theirs are skipped.
DATA ?= ../shared/data
CMAKE_FLAGS ?=

.PHONY: packages build test python paper peers bench

packages:
	@cmake/install-packages.sh

build: packages
	cmake --preset $(PRESET) $(CMAKE_FLAGS)
	cmake --build --preset $(PRESET)

test: build
	ctest --preset $(PRESET) -j 2; status=$$?; \
	  grep -h -A1 ': Skipped$$' build/$(PRESET)/Testing/Temporary/LastTest.log | grep -v -e '^--$$' -e ': Skipped$$' | sort | uniq -c; \
	  exit $$status

PEERS = $(wildcard experiments/peers*.toml)

# Every experiment but those with other meshers: tables, pictures and a page that shows them, under $(RESULTS)/.
paper: EXPERIMENTS = $(filter-out $(PEERS),$(wildcard experiments/*.toml))
# Those; failed cells are part of their tables.
peers: EXPERIMENTS = $(PEERS)
peers: MAY_FAIL = ||:
paper peers: build
	@for e in $(EXPERIMENTS); do \
	  build/$(PRESET)/delquad run $$e --data $(DATA) -o $(RESULTS)/$$(basename $$e .toml) $(MAY_FAIL) || exit $$?; \
	done
	build/$(PRESET)/delquad report $(RESULTS) -o $(RESULTS)/report.html
	@echo "Tables and pictures lie in $(RESULTS)/; $(RESULTS)/report.html shows them."

# The Python module, in build/$(PRESET)/python, and its tests.
python: packages
	cmake --preset $(PRESET) $(CMAKE_FLAGS)
	cmake --build --preset $(PRESET) --target delquad_python
	ctest --preset $(PRESET) -R '^python\.'

bench: build
	@for b in build/$(PRESET)/benchmarks/bench_*; do [ -x $$b ] && [ -f $$b ] && { echo "$$b"; $$b $(BENCH_FLAGS) || exit $$?; }; done
