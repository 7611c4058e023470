/* The keyboard, as the bench has it where a browser leaves the key to a page. */

const ROCKER_KEYS = ['KeyQ', 'KeyA', 'KeyW', 'KeyS', 'KeyE', 'KeyD', 'KeyR', 'KeyF']; // 21..28
const ARROWS = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1]};

/* The bezel's button of a key event, or 0. */
export function buttonOf({code, shiftKey}) {
    const digit = /^Digit(\d)$/.exec(code);
    if (digit) {
        return (Number(digit[1]) + 9) % 10 + 1 + (shiftKey ? 10 : 0);
    }
    return ROCKER_KEYS.includes(code) ? 21 + ROCKER_KEYS.indexOf(code) : 0;
}

/* Listen to the window. `hands` is that of makeBezel; `slew(x, y)` adds to the cursor's deflection;
 * `press` maps other codes of keys to functions. */
export function listen(hands, slew, press) {
    const held = new Map(); // code of a key to what lets it go
    const isTyping = (event) => event.target instanceof HTMLInputElement || event.ctrlKey || event.altKey || event.metaKey;
    window.addEventListener('keydown', (event) => {
        if (isTyping(event) || (event.repeat && held.has(event.code))) {
            return;
        }
        const button = buttonOf(event), arrow = ARROWS[event.code];
        if (button) {
            hands[button].down();
            held.set(event.code, hands[button].up);
        } else if (arrow) {
            slew(...arrow);
            held.set(event.code, () => slew(-arrow[0], -arrow[1]));
        } else if (press[event.code]) {
            press[event.code]();
        } else {
            return;
        }
        event.preventDefault();
    });
    const release = (code) => {
        held.get(code)?.();
        held.delete(code);
    };
    window.addEventListener('keyup', (event) => release(event.code));
    window.addEventListener('blur', () => [...held.keys()].forEach(release));
}
