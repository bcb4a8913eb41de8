// reach.js: requests, with reasons that a visitor or a developer can act on.

// An answer that may be none. what: names it in messages.
export function reach(answer, what, address = 'it') {
    return answer.catch(() => { throw new Error(`no ${what}: ${address} cannot be reached${navigator.onLine === false ? ', because this device is offline' : ''}`); });
}

// Reports the bytes of an answer while they arrive. A copy is read: the browser keeps its compiled code of the answer itself.
async function count(answer, tell) {
    const reader = answer.clone().body.getReader();
    for (let taken = 0; ;) {
        const { value, done } = await reader.read();
        if (done) return;
        tell(taken += value.length);
    }
}

// Fetches and compiles a WebAssembly module. tell(taken): bytes so far, uncompressed.
export async function compileFrom(address, what, tell) {
    const answer = await reach(fetch(address), what, address), type = answer.headers.get('Content-Type');
    if (!answer.ok) throw new Error(`no ${what}: ${address}: the server says ${answer.status}`);
    if (tell) count(answer, tell).catch(() => {}); // the error is reported below
    try {
        // compiles while it arrives, if the server sends the right type
        return await (type === 'application/wasm' ? WebAssembly.compileStreaming(answer) : WebAssembly.compile(await answer.arrayBuffer()));
    } catch (error) {
        if (/content.security|csp/i.test(error.message)) throw new Error(`the Content-Security-Policy of this page forbids WebAssembly: add 'wasm-unsafe-eval' to its script-src`);
        if (error instanceof WebAssembly.CompileError) throw new Error(`no ${what}: ${address} is of the type ${type}, not WebAssembly: put the file there`);
        throw new Error(`no ${what}: the connection was lost`);
    }
}
