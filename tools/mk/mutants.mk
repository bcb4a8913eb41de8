# mutants.mk: planted errors. Included by the Makefile.

# What the table in tests/README.md says of its tests.
mutants: deps-check
	@$(MAKE) --no-print-directory -j$(JOBS) $(TEST_PACKS)
	@NOH_BUILD="$(BUILD)" NOH_ASSETS="$(ASSETS)" JOBS="$(JOBS)" sh tests/mutants.sh

# Errors anywhere in runtime/, chosen by SEED (tests/mutants_seed.sh). The test programs are linked with the library as a
# shared object, so that a mutant compiles one file and links one object: in plain/ without and in lines/ with counts of
# lines. It binds to itself, so that the objects of the tests' archive serve.
SEED     ?= 1
COUNT    ?= 200
SEEDED   := $(BUILD)/mutants_seed
SEEDED_TESTS := $(patsubst tests/%.c,$(SEEDED)/tests/%,$(filter tests/unit/% tests/memory/% tests/gl/%,$(TEST_C)) tests/golden/golden.c)
SEEDED_CC = $(CC) $(ALL_CFLAGS) $(INCLUDES) -DNOH_ASSERT_LEVEL=2
SEEDED_LD = $(CC) -shared -Wl,-Bsymbolic,-soname,libnoh.so $(ALL_LDFLAGS) $(QUICK_LD)

$(SEEDED)/lines/%.o: %.c | $(BUILD)/gen/shaders.gen.h
	@mkdir -p $(@D)
	$(call say,CC,$@)
	$(Q)$(SEEDED_CC) -O1 --coverage -MMD -MP -c $< -o $@

$(SEEDED)/plain/libnoh.so: $(ASSERT_O)
	@mkdir -p $(@D)
	$(call say,LD,$@)
	$(Q)$(SEEDED_LD) $^ -o $@
$(SEEDED)/lines/libnoh.so: $(RUNTIME_C:%.c=$(SEEDED)/lines/%.o) $(BUILD)/gen/shaders.gen.o
	$(call say,LD,$@)
	$(Q)$(SEEDED_LD) --coverage $^ -o $@

$(SEEDED)/tests/%: $(BUILD)/tests/%.o $(TEST_OWN) $(SEEDED)/plain/libnoh.so
	@mkdir -p $(@D)
	$(call say,CXX,$@)
	$(Q)$(CXX) $(ALL_LDFLAGS) $(QUICK_LD) $^ -o $@ -lcmocka $(TOOL_LIBS)

# Which lines of the library a test program runs: once for its source and the library, whatever else is linked again.
$(SEEDED)/map/%.lines: $(BUILD)/tests/%.o $(SEEDED)/lines/libnoh.so | $(SEEDED)/tests/%
	@mkdir -p $(@D)
	$(call say,LINES,$@)
	$(Q)NOH_BUILD="$(BUILD)" NOH_ASSETS="$(ASSETS)" sh tests/mutants_seed.sh --lines $*

mutants-seed-programs: $(SEEDED)/plain/libnoh.so $(SEEDED)/lines/libnoh.so $(SEEDED_TESTS) $(BUILD)/noh
mutants-seed-lines: $(SEEDED_TESTS:$(SEEDED)/tests/%=$(SEEDED)/map/%.lines)

mutants-seed: deps-check
	@$(MAKE) --no-print-directory -j$(JOBS) $(TEST_PACKS) mutants-seed-programs
	@$(MAKE) --no-print-directory -j$(JOBS) mutants-seed-lines
	@NOH_BUILD="$(BUILD)" NOH_ASSETS="$(ASSETS)" JOBS="$(JOBS)" SEEDED_CC="$(SEEDED_CC)" SEEDED_LD="$(SEEDED_LD)" \
	    SEEDED_CXX="$(CXX) $(ALL_LDFLAGS) $(QUICK_LD)" SEEDED_LIBS="$(TEST_OWN) -lcmocka $(TOOL_LIBS)" \
	    SEEDED_O="$(ASSERT_O)" sh tests/mutants_seed.sh $(SEED) $(COUNT)
