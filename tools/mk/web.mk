# web.mk: the page, its converter, its crowd, the npm package. Included by the Makefile.

# ---- the page ----

# One program for all packs: the memory that it runs in is made in the browser, for its pack (platform/web/package).
WEB_PACK    ?= $(BUILD)/page/nell.noh
WEB_WIRE    ?= --error-um 10# of `noh pack`; empty: nothing is rounded
WEB         := $(BUILD)/web/$(basename $(notdir $(WEB_PACK)))
WEB_FLAGS   := -std=c99 -Oz -msimd128 -mnontrapping-fptoint -mbulk-memory $(WARN) $(FP) -Wno-sign-conversion -DNOH_PAGE=1 $(INCLUDES) -Iplatform/web
WEB_STACK   := 65536
WEB_STATIC  := 1048576
WEB_LINK    := -msse2 -s STANDALONE_WASM=1 --no-entry -s IMPORTED_MEMORY=1 -s ALLOW_MEMORY_GROWTH=1 -s MAXIMUM_MEMORY=2147483648 -s MALLOC=none \
               -s INITIAL_MEMORY=$(WEB_STATIC) -s TOTAL_STACK=$(WEB_STACK) -s ERROR_ON_UNDEFINED_SYMBOLS=0
# Blocks made again from their branches, until no pass makes it smaller: 1 % less than what emcc leaves.
WEB_OPT     := $$(em-config BINARYEN_ROOT)/bin/wasm-opt --enable-simd --enable-bulk-memory --enable-nontrapping-float-to-int \
               --enable-mutable-globals --enable-sign-ext --flatten --rereloop -Oz -Oz --converge
WEB_PACKAGE := $(patsubst platform/web/package/%,%,$(wildcard platform/web/package/*))
# A request takes as long as kilobytes do, so the page's scripts are one, and so are the modules that it needs at once.
WEB_SCRIPTS := $(addprefix platform/web/,page.js targets.js load.js light.js faces.js hair.js speech.js tabs.js greet.js)
WEB_MODULES := $(addprefix platform/web/package/,camera.js pixels.js gl.js reach.js program.js pointer.js speech.js character.js)
WEB_FETCHED := noh.wasm body.wasm face.wasm noh.txt body.txt face.txt ear.bin
WEB_PAGE    := $(addprefix $(WEB)/,index.html page.js poster_tall.jpg poster_wide.jpg page.noh page.nohz $(addprefix package/,$(WEB_FETCHED) page.js $(filter %.js,$(WEB_PACKAGE))))
WEB_WORKER    := $(addprefix tools/web_convert/,worker.js webp.js)
WEB_CONVERTER := $(addprefix $(WEB)/package/convert/,convert.js convert.wasm $(notdir $(WEB_WORKER)))
WEB_OBJECTS := $(patsubst $(CURDIR)/%,%,$(BUILD))/web-objects# one name for make, however BUILD is written
WEB_PROGRAMS := $(addprefix $(WEB_OBJECTS)/,noh.wasm body.wasm face.wasm)

web: deps-web
	@$(MAKE) --no-print-directory -j$(JOBS) $(WEB_PACK)
	@$(MAKE) --no-print-directory -j$(JOBS) $(WEB_PAGE)
	@$(MAKE) --no-print-directory -j$(JOBS) $(WEB_CONVERTER) || echo 'The page has no converter: it shows packs alone.'
	@sh tools/web_sizes.sh $(WEB)

# Of the mask, of the page's own, and others; or of one pack, if it is named.
WEB_PACKS   := $(if $(filter file,$(origin WEB_PACK)),$(BUILD)/page/mask.noh $(BUILD)/page/nell.noh $(BUILD)/demo/puppet_levels.noh $(BUILD)/wig.noh $(BUILD)/demo/puppet_falls.noh $(BUILD)/demo/arm_transfer.noh,$(WEB_PACK))
web-check: deps-web
	@$(MAKE) --no-print-directory -j$(JOBS) $(BUILD)/noh $(BUILD)/tests/gl/picture_diff $(BUILD)/demo/arm.glb $(WEB_OBJECTS)/plan.js $(WEB_PACKS)
	@$(MAKE) --no-print-directory DEPS=0 npm
	@NOH_BUILD="$(BUILD)" sh tests/web.sh $(WEB_PACKS)

# HOST=all: also to phones and others in the same network.
PORT ?= 8000
web-serve: web
	@node tools/web_serve.js $(WEB) $(PORT) $(if $(filter all,$(HOST)),all)

# The page's frame beside three.js's.
WEB_BENCH ?= $(ASSETS)/hero/head.glb
web-bench: deps-web
	@[ -f "$(WEB_BENCH)" ] || { echo 'skipped: no $(WEB_BENCH) (ASSETS=DIR says where models are)'; exit 0; }; \
	mkdir -p $(BUILD)/web-bench && \
	$(MAKE) --no-print-directory $(BUILD)/noh $(BUILD)/tests/gl/picture_diff && \
	NOH_BUILD="$(BUILD)" sh tests/web_bench_pack.sh $(WEB_BENCH) $(BUILD)/web-bench/$(basename $(notdir $(WEB_BENCH))).noh && \
	$(MAKE) --no-print-directory DEPS=0 web WEB_WIRE= WEB_PACK=$(BUILD)/web-bench/$(basename $(notdir $(WEB_BENCH))).noh && \
	NOH_BUILD="$(BUILD)" sh tests/web_bench.sh "$(WEB_BENCH)"

# Heads of several makers alive, as a table and as strips.
heads: $(BUILD)/noh $(BUILD)/mask.glb $(BUILD)/demo/nell.glb
	@NOH_BUILD="$(BUILD)" NOH_ASSETS="$(ASSETS)" sh tests/heads.sh

# Heads and bodies by noh, three.js and model-viewer, in noh's lights, as one sheet. LOOKS="FILE FILE:full": other models;
# LOOK_MORE=FILES: more of them.
LOOK_MORE ?=
LOOKS ?= $(BUILD)/mask.glb $(BUILD)/demo/nell.glb $(BUILD)/demo/puppet.glb:full $(ASSETS)/hero/head_skin.glb $(ASSETS)/hero/body.glb:full $(LOOK_MORE)
look: deps-web $(BUILD)/noh $(BUILD)/tests/gl/panorama $(BUILD)/mask.glb $(BUILD)/demo/nell.glb $(BUILD)/demo/puppet.glb
	@NOH_BUILD="$(BUILD)" sh tests/web_look.sh $(LOOKS)

$(WEB)/page.nohz: $(WEB_PACK) $(BUILD)/noh
	@mkdir -p $(@D)
	$(Q)$(BUILD)/noh pack $< -o $@ --json $(WEB_WIRE) >$(@:.nohz=.json)
$(WEB)/page.noh: $(WEB)/page.nohz
	$(Q)$(BUILD)/noh strip $< -o $@ --from-level 0 --quiet
# The page has to know which program shows its pack, its size, for the share that has come, and how many bytes of the pack
# the first picture needs.
$(WEB)/index.html: platform/web/index.html tools/web_index.sh $(WEB)/page.nohz $(WEB_PROGRAMS)
	$(Q)sh tools/web_index.sh $< $(WEB_OBJECTS) $(BUILD)/noh $(WEB)/page.nohz $(WEB)/page.json >$@.new
	@mv $@.new $@
# The face as the page draws it, shown until it does: pictures of 3 kB.
POSTER_tall := 150x325
# Wider than most screens, which cut its sides: the face is as tall as the one that is drawn.
POSTER_wide := 400x170
$(BUILD)/web_poster: tools/web_poster/web_poster.c
	@mkdir -p $(@D)
	$(call say,CC,$@)
	$(Q)$(CC) -std=c99 -O1 -isystem /usr/include/stb $< -lm -o $@
$(WEB)/poster_%.jpg: $(WEB_PACK) $(BUILD)/noh $(BUILD)/web_poster
	@mkdir -p $(@D)
	$(Q)$(BUILD)/noh render $< -o $(WEB)-$*.png --camera face --light studio --size $(POSTER_$*) >/dev/null
	$(Q)$(BUILD)/web_poster $(WEB)-$*.png $@ 3000
	@rm -f $(WEB)-$*.png
$(WEB)/page.js: $(WEB_SCRIPTS)
	@mkdir -p $(@D)
	@cat $^ | sh tools/web_small.sh >$@
$(WEB)/package/page.js: $(WEB_MODULES) tools/web_join.sh
	@mkdir -p $(@D)
	$(Q)sh tools/web_join.sh $@ 'Character addPointers addGaze isSoftware' $(WEB_MODULES)
$(addprefix $(WEB)/package/,$(WEB_FETCHED)): $(WEB)/package/%: $(WEB_OBJECTS)/%
	@mkdir -p $(@D)
	@cp $< $@
$(WEB)/%: platform/web/%
	@mkdir -p $(@D)
	@cp $< $@

# The program with everything, the ones of bodies and of faces, and the planner that the tests run under node.
# context.c brings functions of WebGL in place of gl_api_load.c.
WEB_C := $(filter-out %/plan.c %/face_only.c %/without_falls.c %/unread.c %/unclothed.c %/unmoved.c %/device/gl_api_load.c,$(wildcard platform/web/*.c) $(RUNTIME_C)) tools/noh/draw/facing.c
WEB_O := $(WEB_C:%.c=$(WEB_OBJECTS)/%.o) $(WEB_OBJECTS)/shaders.gen.o
WEB_BODY_O := $(filter-out %/web/cast_fall.o %/web/push.o %/web/vertices.o,$(WEB_O)) $(WEB_OBJECTS)/platform/web/without_falls.o
WEB_FACE_O := $(filter-out %/web/cast_body.o %/web/hair.o %/draw/facing.o,$(WEB_BODY_O)) $(WEB_OBJECTS)/platform/web/face_only.o
WEB_PLAN_O := $(addprefix $(WEB_OBJECTS)/platform/web/,plan.o cast.o cast_body.o cast_fall.o) $(WEB_OBJECTS)/platform/file.o $(filter-out $(WEB_OBJECTS)/platform/%,$(WEB_O))
WEB_CC := NODE_PATH="$$NODE_PATH:/usr/share/nodejs" emcc # links; Debian's emscripten uses Debian's node modules
$(BUILD)/web-cc: tools/web_cc.sh
	@mkdir -p $(@D)
	$(Q)sh tools/web_cc.sh $@ -fwasm-exceptions -msimd128 -msse2
$(WEB_OBJECTS)/%.o: %.c | $(BUILD)/web-cc
	@mkdir -p $(@D)
	$(call say,EMCC,$@)
	$(Q)$(BUILD)/web-cc $(WEB_FLAGS) -MMD -MP -c $< -o $@
# C asks for uniforms by name: what a string has keeps its name.
WEB_NAMING := $(RUNTIME_C) $(wildcard platform/web/*.c platform/web/festival/*.c tools/noh/crowd/*.c)
$(WEB_OBJECTS)/shaders.gen.c: $(BUILD)/gen/shaders.gen.c tools/web_shaders.js $(WEB_NAMING)
	@mkdir -p $(@D)
	$(Q)node tools/web_shaders.js $< $@.new $(WEB_NAMING)
	@mv $@.new $@
$(WEB_OBJECTS)/shaders.gen.o: $(WEB_OBJECTS)/shaders.gen.c | $(BUILD)/web-cc
	$(call say,EMCC,$@)
	$(Q)$(BUILD)/web-cc $(WEB_FLAGS) -MMD -MP -c $< -o $@
$(WEB_OBJECTS)/plan.js: $(WEB_PLAN_O)
	$(call say,EMCC,$@)
	$(Q)$(WEB_CC) $(WEB_FLAGS) $^ -s NODERAWFS=1 -s EXIT_RUNTIME=1 -s ALLOW_MEMORY_GROWTH=1 -o $@
-include $(WEB_O:.o=.d) $(WEB_FACE_O:.o=.d) $(WEB_PLAN_O:.o=.d)

# The ear's tables come apart (platform/web/ear_apart.c); what a program does not read, it does not check (unread.c,
# face_only.c), no character wears garments (unclothed.c), no kind changes and nothing asks where vertices were (unmoved.c).
WEB_LEFT_OUT := %/life/face/ear_tables.o %/pack/check_match.o %/pack/check_terrain.o %/cast/stage_wear.o %/stage/stage_cover.o %/cast/stage_slot.o %/stage/stage_gl_slot.o %/stage/stage_motion.o
WEB_STANDS_IN := $(addprefix $(WEB_OBJECTS)/platform/web/,unread.o unclothed.o unmoved.o)
$(WEB_OBJECTS)/noh.wasm: $(filter-out $(WEB_LEFT_OUT),$(WEB_O)) $(WEB_STANDS_IN)
$(WEB_OBJECTS)/body.wasm: $(filter-out $(WEB_LEFT_OUT),$(WEB_BODY_O)) $(WEB_STANDS_IN)
$(WEB_OBJECTS)/face.wasm: $(filter-out $(WEB_LEFT_OUT) %/pack/check_hair.o %/pack/check_springs.o,$(WEB_FACE_O)) $(WEB_STANDS_IN)
$(WEB_OBJECTS)/ear.bin: tools/web_ear/web_ear.c runtime/life/face/ear_tables.c runtime/life/face/ear_internal.h
	@mkdir -p $(@D)
	$(call say,CC,$@)
	$(Q)$(CC) -std=c99 -O1 $(WARN) $(INCLUDES) $(filter %.c,$^) -o $(BUILD)/web_ear
	$(Q)$(BUILD)/web_ear >$@.new
	@mv $@.new $@
# The rows of bone_names.c are words that are compared, no sentences.
$(WEB_PROGRAMS): tools/web_messages.js
	$(call say,EMCC,$@)
	$(Q)$(WEB_CC) $(WEB_FLAGS) $(filter %.o,$^) $(WEB_LINK) -o $@ 2>$@.log || { cat $@.log; exit 1; }
	$(Q)$(WEB_OPT) $@ -o $@
	$(Q)node tools/web_messages.js $@ $(@:.wasm=.txt) $(filter-out %/bone_names.c,$(filter runtime/%,$(RUNTIME_C))) $(call sources,runtime,*_internal.h)
	$(Q)! grep 'undefined symbol' $@.log | grep -v 'symbol: \(gl[A-Z]\|enable\|extension\|feedback\|height\|keep_baked\|lost\|string\|take_baked\|width\)'
$(WEB_OBJECTS)/%.txt: $(WEB_OBJECTS)/%.wasm ;

# ---- the page's converter ----

# `noh build` and `noh pack` as WebAssembly, which a page loads when a model is dropped on it (tools/web_convert). Headers
# of its libraries come from Debian's packages; meshoptimizer, which has more than headers, from their sources. Draco is
# left out: what needs it is refused.
WEB_CONVERT   := $(BUILD)/web-convert
WEB_CONVERT_O := $(patsubst %,$(WEB_CONVERT)/%.o,$(basename $(addprefix tools/web_convert/,main.c webp_browser.c model_none.c stb.c libraries.cpp) \
                 tools/noh/build/cmd_build.c tools/noh/build/build_fail.c tools/noh/build/depfile.c tools/noh/pack/cmd_pack.c tools/noh/file/pack_file.c platform/file.c platform/file_write.c \
                 $(addprefix tools/noh/cli/,args.c json.c message.c report_stream.c) $(filter-out %/webp_file.c,$(CONVERT_C)) $(CONVERT_CC))) \
                 $(patsubst %,$(WEB_CONVERT)/meshoptimizer/src/%.o,allocator indexcodec overdrawoptimizer vcacheoptimizer vertexcodec vertexfilter)
WEB_CONVERT_FLAGS := -O2 -msimd128 $(FP) -isystem $(WEB_CONVERT)/include
WEB_CONVERT_LINK  := -fwasm-exceptions -s ALLOW_MEMORY_GROWTH=1 -s MAXIMUM_MEMORY=2GB -s STACK_OVERFLOW_CHECK=0 -s ENVIRONMENT=worker \
                     -s TOTAL_STACK=1MB -s MODULARIZE=1 -s EXPORT_ES6=1 -s USE_ES6_IMPORT_META=0 -s EXPORT_NAME=nohConvert -s INVOKE_RUN=0 \
                     -s EXPORTED_RUNTIME_METHODS=FS,callMain -s INCOMING_MODULE_JS_API=stdout,stderr,instantiateWasm -s DYNAMIC_EXECUTION=0

# Headers that any processor can have, and nothing else of /usr/include.
$(WEB_CONVERT)/include/.made: tools/web_convert/meshoptimizer.sh
	@mkdir -p $(@D)
	$(Q)sh tools/web_convert/meshoptimizer.sh $(WEB_CONVERT)
	$(Q)ln -sfn /usr/include/nlohmann /usr/include/stb /usr/include/tiny_gltf.h $(abspath $(WEB_CONVERT)/meshoptimizer/src/meshoptimizer.h) $(@D)
	@touch $@
$(WEB_CONVERT)/%.o: %.c $(WEB_CONVERT)/include/.made | $(BUILD)/web-cc
	@mkdir -p $(@D)
	$(call say,EMCC,$@)
	$(Q)$(BUILD)/web-cc -std=c99 $(WEB_CONVERT_FLAGS) $(INCLUDES) -MMD -MP -c $< -o $@
$(WEB_CONVERT)/tools/%.o: tools/%.cpp $(WEB_CONVERT)/include/.made | $(BUILD)/web-cc
	@mkdir -p $(@D)
	$(call say,EMCC,$@)
	$(Q)$(BUILD)/web-cc -std=c++17 -fwasm-exceptions $(WEB_CONVERT_FLAGS) -O1 -isystem /usr/include/stb $(INCLUDES) -MMD -MP -c $< -o $@
$(WEB_CONVERT)/meshoptimizer/%.o: $(WEB_CONVERT)/include/.made | $(BUILD)/web-cc
	$(call say,EMCC,$@)
	$(Q)$(BUILD)/web-cc $(WEB_CONVERT_FLAGS) -U__SSE2__ -w -c $(@:.o=.cpp) -o $@
$(WEB_CONVERT)/convert.js: $(WEB_CONVERT_O) $(filter-out $(WEB_OBJECTS)/platform/%,$(WEB_O))
	$(call say,EMCC,$@)
	$(Q)$(WEB_CC) $(WEB_CONVERT_FLAGS) $^ $(WEB_CONVERT_LINK) -o $@
-include $(WEB_CONVERT_O:.o=.d)
$(WEB_CONVERT)/convert.wasm: $(WEB_CONVERT)/convert.js
$(WEB)/package/convert/w%.js: tools/web_convert/w%.js
	@mkdir -p $(@D)
	@cp $< $@
$(WEB)/package/convert/convert.%: $(WEB_CONVERT)/convert.%
	@mkdir -p $(@D)
	@cp $< $@

# ---- the page's crowd ----

# `noh crowd --place` as a page of its own (platform/web/festival), of files of the tool and of what `make demo-crowd` shows.
# Its memory does not grow: a thousand people fit.
WEB_FESTIVAL   := $(WEB)/festival
WEB_FESTIVAL_O := $(patsubst %.c,$(WEB_OBJECTS)/%.o,platform/web/festival/festival.c platform/web/context.c platform/file.c \
                  $(addprefix tools/noh/crowd/,place_scene.c place_life.c place_people.c place_file.c crowd_measure.c crowd_hair.c) \
                  tools/noh/draw/lighting.c tools/noh/build/build_fail.c tools/noh/file/pack_file.c tools/noh/cli/message.c) \
                  $(patsubst %,$(WEB_CONVERT)/tools/%.o,web_convert/webp_browser web_convert/model_none web_convert/stb noh/file/light_file $(addprefix convert/base/,error bmp_file file_kind nearest image_file image_whole input_file psd_file tga_file text_scan))
WEB_FESTIVAL_FILES := $(addprefix $(WEB_FESTIVAL)/,index.html festival.js people.nohz festival.nohz festival.place)

web-festival: web
	@$(MAKE) --no-print-directory -j$(JOBS) $(WEB_FESTIVAL)/program.js $(WEB_FESTIVAL_FILES)
$(WEB_FESTIVAL)/program.js: $(WEB_FESTIVAL_O) $(filter-out $(WEB_OBJECTS)/platform/%,$(WEB_O))
	@mkdir -p $(@D)
	$(call say,EMCC,$@)
	$(Q)$(WEB_CC) $(WEB_FLAGS) -O1 $^ -msse2 --no-entry -s ALLOW_MEMORY_GROWTH=0 -s INITIAL_MEMORY=64MB -s TOTAL_STACK=1MB -s ENVIRONMENT=web \
	    -s MODULARIZE=1 -s EXPORT_NAME=nohFestival -s EXPORTED_RUNTIME_METHODS=UTF8ToString,FS -s FORCE_FILESYSTEM=1 \
	    -s INCOMING_MODULE_JS_API=instantiateWasm -s ERROR_ON_UNDEFINED_SYMBOLS=0 -o $@ 2>$(WEB_OBJECTS)/festival.log || { cat $(WEB_OBJECTS)/festival.log; exit 1; }
	$(Q)! grep 'undefined symbol' $(WEB_OBJECTS)/festival.log | grep -v 'symbol: \(gl[A-Z]\|enable\|extension\|feedback\|height\|lost\|string\|width\)'
# From the third level down: a camera that is 3 m away sees no finer one.
$(WEB_OBJECTS)/festival/people.noh: $(BUILD)/demo/puppet.glb $(PUPPET_MOVES) $(BUILD)/noh
	@mkdir -p $(@D)
	$(Q)$(BUILD)/noh build $< -o $@ --plain --wrinkles face --lod 8 --lod-from 2 --graph $(PUPPET_MOVES) --quiet
$(WEB_FESTIVAL)/people.nohz: $(WEB_OBJECTS)/festival/people.noh
	@mkdir -p $(@D)
	$(Q)$(BUILD)/noh pack $< -o $@ --error-um 10 --quiet
$(WEB_FESTIVAL)/festival.nohz: $(BUILD)/demo_assets $(BUILD)/noh
	@mkdir -p $(@D) $(WEB_OBJECTS)/festival
	$(Q)$(BUILD)/demo_assets --festival $(WEB_OBJECTS)/festival/festival
	$(Q)$(BUILD)/noh build $(WEB_OBJECTS)/festival/festival.obj -o $(WEB_OBJECTS)/festival/festival.noh --unit-cm 100 --quiet
	$(Q)$(BUILD)/noh pack $(WEB_OBJECTS)/festival/festival.noh -o $@ --error-um 10 --quiet
$(WEB_FESTIVAL)/festival.place: tools/demo_assets/festival/festival.place
	@mkdir -p $(@D)
	@cp $< $@
$(WEB_FESTIVAL)/%: platform/web/festival/%
	@mkdir -p $(@D)
	@cp $< $@

# ---- the package ----

# noh-character for npm: what platform/web/package has, the program, and the version of the library.
NPM := $(BUILD)/npm
npm: deps-web
	@$(MAKE) --no-print-directory -j$(JOBS) $(WEB_CONVERT)/convert.wasm || echo 'The package has no converter: it shows packs alone.'
	@$(MAKE) --no-print-directory -j$(JOBS) $(NPM)/noh-character-$(VERSION).tgz
$(NPM)/noh-character-$(VERSION).tgz: $(addprefix platform/web/package/,$(WEB_PACKAGE)) $(addprefix $(WEB_OBJECTS)/,$(WEB_FETCHED)) LICENSE tools/npm.sh runtime/noh/base.h \
    $(WEB_WORKER) $(wildcard $(WEB_CONVERT)/convert.wasm)
	@VERSION=$(VERSION) sh tools/npm.sh $(NPM) platform/web/package $(WEB_OBJECTS) LICENSE $(WEB_CONVERT) $(WEB_WORKER)
