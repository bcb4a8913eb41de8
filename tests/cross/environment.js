// environment.js: programs of emscripten see node's environment, as others see theirs (NOH_LONG, NOH_EMULATED).
Module.preRun = [() => { if (typeof ENV !== 'undefined') Object.assign(ENV, process.env); }];
