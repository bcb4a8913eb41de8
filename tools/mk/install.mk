# install.mk: installing, the amalgam, the examples, sizes, lint, documents. Included by the Makefile.

# ---- installing, and what is made of the library ----

PREFIX     ?= /usr/local
BINDIR     ?= $(PREFIX)/bin
LIBDIR     ?= $(PREFIX)/lib
INCLUDEDIR ?= $(PREFIX)/include
DATADIR    ?= $(PREFIX)/share
INSTALL    := BUILD="$(BUILD)" VERSION="$(VERSION)" CC="$(CC)" TOOL_LIBS="$(TOOL_LIBS)" DESTDIR="$(DESTDIR)" PREFIX="$(PREFIX)" BINDIR="$(BINDIR)" \
              LIBDIR="$(LIBDIR)" INCLUDEDIR="$(INCLUDEDIR)" DATADIR="$(DATADIR)" sh tools/install/install.sh

install: all
	@$(INSTALL) all
# Needs no C++ compiler and none of the tools' libraries: make install-lib CC=... AR=... for another processor.
install-lib: lib
	@$(INSTALL) lib
uninstall:
	@$(INSTALL) remove

# make amalgam; tests links some tests with it instead of libnoh.a.
amalgam: $(AMALGAM)/noh.c
$(AMALGAM)/noh.c: $(BUILD)/amalgamate $(RUNTIME_C) $(call sources,runtime,*.h) $(BUILD)/gen/shaders.gen.c
	@mkdir -p $(@D)
	$(call say,AMALG,$@)
	@rm -rf $(@D)/noh && mkdir -p $(@D)/noh && cp runtime/noh/*.h $(@D)/noh
	$(Q)$(BUILD)/amalgamate -o $(@D) -I runtime -I $(BUILD)/gen $(patsubst runtime/%,%,$(wildcard runtime/noh/*.h) $(RUNTIME_C)) shaders.gen.c
$(BUILD)/amalgamate: tools/amalgam/amalgam.c
	@mkdir -p $(@D)
	$(call say,CC,$@)
	$(Q)$(HOSTCC) -std=c99 -O2 $(WARN) $(SANFLAGS) $< -o $@
# Gcc takes 4 s to look at the indentation of a file of this length.
$(AMALGAM)/noh.o: $(AMALGAM)/noh.c
	$(call say,CC,$@)
	$(Q)$(CC) $(ALL_CFLAGS) -Wno-misleading-indentation -I$(AMALGAM) -c $< -o $@
$(AMALGAM)/%: $(BUILD)/tests/%.o $(filter-out %/libnoh.a,$(TEST_LIBS)) $(AMALGAM)/noh.o
	@mkdir -p $(@D)
	$(call say,CXX,$@)
	$(Q)$(CXX) $(ALL_LDFLAGS) $(QUICK_LD) $^ -o $@ -lcmocka $(TOOL_LIBS)

# Small programs that show the library; they may use platform/ for a GL context.
examples: $(EXAMPLES)
$(BUILD)/examples/%: $(BUILD)/tools/examples/%.o $(BUILD)/libnoh.a
	@mkdir -p $(@D)
	$(call say,CC,$@)
	$(Q)$(CC) $(ALL_LDFLAGS) $^ -o $@ $(if $(shell grep -lsE '<EGL/|start.h' tools/examples/$*.c),-lEGL) \
	    $(if $(shell grep -ls measure.h tools/examples/$*.c),$(addprefix -Wl$(comma)--wrap=,malloc calloc realloc))

# api-update: the API of this version, to which later ones are compared (tests/check_api.sh).
api-update:
	@{ echo 'noh $(VERSION)'; sh tools/release/api.sh; } >tools/release/api.new && mv tools/release/api.new tools/release/api.txt
# A release: archive, Debian packages, npm package, port, recipe, list of files, checksums.
release:
	@NOH_BUILD="$(BUILD)" VERSION="$(VERSION)" sh tools/release/release.sh $(BUILD)/release
# The Debian packages built twice, read by lintian, installed into a minimal Debian, used and removed.
release-check:
	@NOH_BUILD="$(BUILD)" VERSION="$(VERSION)" sh tools/release/check_packages.sh $(BUILD)/release

# Code and data of the library by processor, against the table of the last commit; make sizes-update writes that table.
sizes:
	@NOH_BUILD="$(BUILD)" JOBS="$(JOBS)" sh tools/sizes.sh
sizes-update:
	@NOH_BUILD="$(BUILD)" JOBS="$(JOBS)" sh tools/sizes.sh --update

deps-lint:
	@[ "$(DEPS)" = 0 ] || sh tools/deps.sh build view lint
lint: deps-lint
	@$(MAKE) --no-print-directory $(BUILD)/gen/shaders.gen.h $(BUILD)/gen/tool_shaders.gen.h
	@sh tools/lint/prose.sh
	@NOH_BUILD="$(BUILD)" JOBS="$(JOBS)" sh tools/lint/lint.sh

deps-docs:
	@[ "$(DEPS)" = 0 ] || sh tools/deps.sh docs
docs: deps-docs
	@NOH_BUILD="$(BUILD)" VERSION="$(VERSION)" sh tools/docs/docs.sh
pictures: $(BUILD)/noh $(BUILD)/mask.noh $(BUILD)/mask_levels.noh $(BUILD)/wig.noh \
    $(addprefix $(BUILD)/demo/,nell.noh puppet.noh puppet_levels.noh puppet_falls.noh)
	@sh tools/docs/pictures.sh "$(BUILD)" $(PICTURES)
