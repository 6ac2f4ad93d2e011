// Drives the page for tests/page.rs, which puts the links here and hears what is said.
"use strict";
const LINKS = /*LINKS*/[];
const FILES = /*FILES*/[];
const errors = [];
{
    const complain = console.error;
    console.error = (...words) => { errors.push(words.join(" ")); complain(...words); };
    addEventListener("error", event => errors.push(String(event.message)));
    addEventListener("unhandledrejection", event => errors.push(String(event.reason)));
}
const frame = () => new Promise(resolve => requestAnimationFrame(resolve));
const sleep = ms => new Promise(resolve => setTimeout(resolve, ms));
const tell = what => fetch("/said?" + encodeURIComponent(JSON.stringify({ ...what, address: location.hash, errors })));

// Mean colour of the middle of the canvas, 0 to 255. A canvas has its picture only in the frame in which it was drawn, so one is asked for, by the
// mouse, and looked at after the application has had its turn in it.
async function colour() {
    const canvas = document.getElementById("canvas");
    const copy = new OffscreenCanvas(40, 30).getContext("2d", { willReadFrequently: true });
    for (let turn = 0; ; turn++) {
        mouse("mousemove", 2 + turn % 2, 2);
        // Asked for after the application has asked for the same frame: its turn is before ours.
        await sleep(0);
        await frame();
        const [width, height] = [canvas.width, canvas.height];
        copy.clearRect(0, 0, 40, 30);
        copy.drawImage(canvas, width * 0.4, height * 0.25, width * 0.2, height * 0.2, 0, 0, 40, 30);
        const { data } = copy.getImageData(0, 0, 40, 30);
        if (data[3] > 0) {
            const sum = [0, 0, 0];
            data.forEach((value, index) => { if (index % 4 < 3) sum[index % 4] += value; });
            return sum.map(value => value / 1200);
        }
        await sleep(20);
    }
}

// The grey where a picture is still being drawn.
const EMPTY = [24, 24, 24];

// The colour once it is another than it was, that of a picture, and stays as it is.
async function changed(before) {
    const far = (a, b) => Math.max(...a.map((value, index) => Math.abs(value - b[index])));
    let last = await colour();
    for (let same = 0; same < 8;) {
        await sleep(100);
        const now = await colour();
        same = far(now, last) < 0.5 && far(now, before) > 1 && far(now, EMPTY) > 1 ? same + 1 : 0;
        last = now;
    }
    return last;
}

function mouse(kind, x, y, buttons = 0) {
    const canvas = document.getElementById("canvas");
    const event = { bubbles: true, cancelable: true, clientX: x, clientY: y, button: 0, buttons, pointerId: 1, isPrimary: true };
    canvas.dispatchEvent(kind.startsWith("pointer") ? new PointerEvent(kind, event) : new MouseEvent(kind, event));
}

async function drag(x, y, by) {
    mouse("mousemove", x, y);
    await frame();
    mouse("pointerdown", x, y, 1);
    for (let step = 1; step <= 10; step++) {
        await sleep(30);
        mouse("mousemove", x + by * step / 10, y, 1);
    }
    await sleep(30);
    mouse("pointerup", x + by, y);
}

function drop(files) {
    const given = new DataTransfer();
    files.forEach(file => given.items.add(file));
    document.getElementById("canvas").dispatchEvent(new DragEvent("drop", { bubbles: true, cancelable: true, dataTransfer: given }));
}

// A key with Ctrl.
function press(key) {
    const event = { bubbles: true, cancelable: true, key, code: "Key" + key.toUpperCase(), ctrlKey: true };
    const canvas = document.getElementById("canvas");
    canvas.dispatchEvent(new KeyboardEvent("keydown", event));
    canvas.dispatchEvent(new KeyboardEvent("keyup", event));
}

// The next download, which nobody gets to see.
const download = () => new Promise(resolve => {
    HTMLAnchorElement.prototype.click = async function () {
        resolve({ name: this.download, text: await (await fetch(this.href)).text() });
    };
});

(async () => {
    try {
        const said = () => document.getElementById("said").textContent;
        while (said() === "Loading the explorer" || document.readyState !== "complete") await sleep(50);
        if (said()) throw new Error(said());
        let now = await changed(EMPTY);
        await tell({ colour: now });
        for (const link of LINKS) {
            location.hash = link;
            now = await changed(now);
            await tell({ colour: now });
        }
        const address = location.hash;
        await drag(innerWidth * 0.5, innerHeight * 0.3, 80);
        now = await changed(now);
        while (location.hash === address) await sleep(50);
        await tell({ colour: now });
        const files = await Promise.all(FILES.map(async name => new File([await (await fetch("/files/" + name)).blob()], name)));
        drop(files);
        now = await changed(now);
        await tell({ colour: now });
        const saved = download();
        press("s");
        const { name, text } = await saved;
        await tell({ saved: name, same: text === await files[0].text() });
    } catch (error) {
        await tell({ error: String(error?.stack ?? error) });
    }
})();
