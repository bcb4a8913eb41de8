// compile.js: fetches and compiles a WebAssembly module, with reasons that a developer can act on.

// what: names it in messages.
export async function compileFrom(address, what) {
    const answer = await fetch(address).catch(() => { throw new Error(`no ${what}: ${address} cannot be reached`); });
    if (!answer.ok) throw new Error(`no ${what}: ${address}: the server says ${answer.status}`);
    const type = answer.headers.get('Content-Type');
    try {
        // compiles while it arrives, if the server sends the right type
        return await (type === 'application/wasm' ? WebAssembly.compileStreaming(answer) : WebAssembly.compile(await answer.arrayBuffer()));
    } catch (error) {
        if (/content.security|csp/i.test(error.message)) throw new Error(`the Content-Security-Policy of this page forbids WebAssembly: add 'wasm-unsafe-eval' to its script-src`);
        if (error instanceof WebAssembly.CompileError) throw new Error(`no ${what}: ${address} is of the type ${type}, not WebAssembly: put the file there`);
        throw new Error(`no ${what}: the connection was lost`);
    }
}
