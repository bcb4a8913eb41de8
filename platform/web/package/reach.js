// reach.js: requests, with reasons that a visitor or a developer can act on.

// An answer that may be none. what: names it in messages.
export function reach(answer, what, address = 'it') {
    return answer.catch(() => { throw new Error(`no ${what}: ${address} cannot be reached${navigator.onLine === false ? ', because this device is offline' : ''}`); });
}

// Fetches and compiles a WebAssembly module.
export async function compileFrom(address, what) {
    const answer = await reach(fetch(address), what, address), type = answer.headers.get('Content-Type');
    if (!answer.ok) throw new Error(`no ${what}: ${address}: the server says ${answer.status}`);
    try {
        // compiles while it arrives, if the server sends the right type
        return await (type === 'application/wasm' ? WebAssembly.compileStreaming(answer) : WebAssembly.compile(await answer.arrayBuffer()));
    } catch (error) {
        if (/content.security|csp/i.test(error.message)) throw new Error(`the Content-Security-Policy of this page forbids WebAssembly: add 'wasm-unsafe-eval' to its script-src`);
        if (error instanceof WebAssembly.CompileError) throw new Error(`no ${what}: ${address} is of the type ${type}, not WebAssembly: put the file there`);
        throw new Error(`no ${what}: the connection was lost`);
    }
}
