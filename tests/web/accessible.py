"""What a page gives to those who do not see it, or see it badly, or have a keyboard alone: asked of the browser.

Names and roles are those that the browser computes for screen readers (WebDriver's computedlabel and computedrole).
Contrast is that of WCAG 2.1, sections 1.4.3 and 1.4.11: 4.5 for text, 3 for large text, for the border or the ground of
a field, and for what shows the focus."""
import re

from browser import Keys

CONTROLS = "button, input, select, textarea, a[href], canvas, [tabindex]"
ROLES = {"button": {"button", "tab"}, "a": {"link"}, "select": {"combobox"}, "canvas": {"img", "image", "application"},
         "ol": {"list"}, "range": {"slider"}, "number": {"spinbutton"}, "text": {"textbox"}, "file": {"button"},
         "checkbox": {"checkbox"}, "radio": {"radio"}}
STEPS_MOST = 200

# Colours as they are seen: what lies over each other, mixed. WCAG's relative luminance and contrast.
LOOK = """
globalThis.look ??= (() => {
    const numbers = (css) => { const n = css.match(/[\\d.]+/g).map(Number); return [n[0], n[1], n[2], n[3] ?? 1]; };
    const over = ([r, g, b, a], below) => [r, g, b].map((c, i) => c * a + below[i] * (1 - a));
    const ground = (e) => e ? over(numbers(getComputedStyle(e).backgroundColor), ground(e.parentElement)) : [255, 255, 255];
    const light = (rgb) => rgb.map((c) => c / 255).map((c) => c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4)
        .reduce((sum, c, i) => sum + c * [0.2126, 0.7152, 0.0722][i], 0);
    const contrast = (a, b) => { const [x, y] = [light(a), light(b)]; return (Math.max(x, y) + 0.05) / (Math.min(x, y) + 0.05); };
    const isSeen = (e) => e.checkVisibility({checkOpacity: true, checkVisibilityCSS: true}) && e.getBoundingClientRect().width > 1;
    const named = (e) => `${e.tagName.toLowerCase()}${e.id ? '#' + e.id : ''} "${(e.textContent || e.value || '').trim().slice(0, 30)}"`;
    const isOff = (e) => Boolean(e.closest(':disabled, [aria-disabled=true]')) || [...e.labels ?? [], ...(e.closest('label')?.control ? [e.closest('label')] : [])]
        .some((label) => label.control?.matches(':disabled'));
    return {numbers, over, ground, contrast, isSeen, named, isOff};
})();"""

TEXTS = """
const {numbers, over, ground, contrast, isSeen, named, isOff} = look, low = [];
let count = 0;
for (const e of document.body.querySelectorAll('*')) {
    const hasText = [...e.childNodes].some((n) => n.nodeType === 3 && n.data.trim()) || e.matches('input[type=text], input[type=number], select');
    if (!hasText || e.matches('option, script') || !isSeen(e) || isOff(e)) { continue; }
    const style = getComputedStyle(e), px = parseFloat(style.fontSize), isLarge = px >= 24 || px >= 18.66 && style.fontWeight >= 700;
    const ratio = contrast(over(numbers(style.color), ground(e)), ground(e));
    count++;
    if (ratio < (isLarge ? 3 : 4.5)) { low.push(`${named(e)} ${ratio.toFixed(2)}`); }
}
return [count, low];"""

FIELDS = """
const {numbers, over, ground, contrast, isSeen, named, isOff} = look;
return [...document.querySelectorAll('input[type=text], input[type=number], select')].filter((e) => isSeen(e) && !isOff(e)).map((e) => {
    const around = ground(e.parentElement), style = getComputedStyle(e);
    return [named(e), Math.max(contrast(ground(e), around), contrast(over(numbers(style.borderTopColor), around), around))];
}).filter(([, ratio]) => ratio < 3).map(([name, ratio]) => `${name} ${ratio.toFixed(2)}`);"""

FOCUS = """
const {numbers, over, ground, contrast, isSeen, named} = look, e = document.activeElement;
if (e === document.body || e === document.documentElement) { return null; }
const shows = [e, e.closest('label')].filter((x) => x && isSeen(x)).map((x) => [x, getComputedStyle(x)])
    .filter(([, s]) => s.outlineStyle !== 'none' && parseFloat(s.outlineWidth) >= 2);
const best = Math.max(0, ...shows.map(([x, s]) => contrast(over(numbers(s.outlineColor), ground(x.parentElement)), ground(x.parentElement))));
const r = (shows[0]?.[0] ?? e).getBoundingClientRect();
return {name: named(e), contrast: best, at: [...document.querySelectorAll('*')].indexOf(e),
    isInView: r.bottom > 0 && r.right > 0 && r.top < innerHeight && r.left < innerWidth};"""

PARTS = """
const refs = ['aria-labelledby', 'aria-describedby', 'aria-controls', 'for'], ids = [...document.querySelectorAll('[id]')].map((e) => e.id);
return {lang: document.documentElement.lang, title: document.title,
    levels: [...document.querySelectorAll('h1, h2, h3')].map((h) => Number(h.tagName[1])),
    twice: ids.filter((id, n) => ids.indexOf(id) !== n),
    lost: refs.flatMap((ref) => [...document.querySelectorAll(`[${ref}]`)].flatMap((e) => e.getAttribute(ref).split(/\\s+/)))
        .filter((id) => !document.getElementById(id)),
    mains: document.querySelectorAll('main').length,
    moves: document.getAnimations().length,
    wide: document.documentElement.scrollWidth - innerWidth};"""

# Targets below 24 CSS pixels whose neighbour is within the 24 pixels (WCAG 2.2, 2.5.8).
SMALL = """
const seen = [...document.querySelectorAll('button, select, input:not([type=range])')].filter((e) => look.isSeen(e)).map((e) => {
    const box = (e.closest('label') ?? e).getBoundingClientRect();
    return {name: look.named(e), w: box.width, h: box.height, x: box.x + box.width / 2, y: box.y + box.height / 2};
});
return seen.filter((a) => Math.min(a.w, a.h) < 24 && seen.some((b) => a !== b && Math.hypot(a.x - b.x, a.y - b.y) < 24))
    .map(({name, w, h}) => `${name} ${w.toFixed(0)} x ${h.toFixed(0)}`);"""


def _words(text):
    return re.findall(r"[a-z0-9]+", text.lower())


def check_names(b):
    """Each control has a role that fits and a name that has the words that are seen. Returns how many were asked."""
    b.run(LOOK)
    wrong, names, asked = [], [], 0
    for element, tag, kind, text in b.ask(
            f"[...document.querySelectorAll('{CONTROLS}')].filter((e) => look.isSeen(e) || e.matches('[type=radio]') && look.isSeen(e.parentElement))"
            ".map((e) => [e, e.tagName.toLowerCase(), e.type ?? '', e.matches('button, a') ? e.textContent : ''])"):
        role, name = element.aria_role, element.accessible_name.strip()
        asked += 1
        wanted = ROLES.get(kind if tag == "input" else tag)
        if wanted and role not in wanted or not name:
            wrong.append(f"<{tag} {kind}> has the role {role!r} and the name {name!r}")
        if not set(_words(text)) <= set(_words(name)):
            wrong.append(f"<{tag}> shows {text!r} and is named {name!r}")
        names.append((role, name))
    twice = {of for of in names if names.count(of) > 1}
    assert not wrong and not twice, (wrong, twice)
    return asked


def check_contrast(b):
    """Text, and the borders of fields. Returns how many texts were looked at."""
    count, low = b.driver.execute_script(LOOK + TEXTS)
    fields = b.driver.execute_script(LOOK + FIELDS)
    assert not low and not fields, (low, fields)
    return count


def check_parts(b):
    parts = b.driver.execute_script(LOOK + PARTS)
    levels = parts["levels"]
    assert parts["lang"] == "en" and parts["title"] and parts["mains"] == 1, parts
    assert levels[0] == 1 == levels.count(1) and all(y <= x + 1 for x, y in zip(levels, levels[1:])), levels
    assert not parts["twice"] and not parts["lost"] and parts["moves"] == 0 and parts["wide"] <= 0, parts


def check_sizes(b):
    small = b.driver.execute_script(LOOK + SMALL)
    assert not small, small


def check_focus(b):
    """Tab goes once round all there is, in the order of the page, and is seen wherever it stands. Returns its stops."""
    # The next Tab goes to the first stop, wherever the focus was before.
    b.run("document.body.tabIndex = -1; document.body.focus(); document.body.removeAttribute('tabindex'); scrollTo(0, 0)")
    stops = []
    for _ in range(STEPS_MOST):
        b.press(Keys.TAB)
        stop = b.driver.execute_script(LOOK + FOCUS)
        if stop is None or stops and stop["at"] == stops[0]["at"]:
            break
        assert stop["contrast"] >= 3 and stop["isInView"], f"the focus is not seen: {stop}"
        stops.append(stop)
    places = [stop["at"] for stop in stops]
    assert places == sorted(set(places)), "the focus goes back"
    wanted = b.ask("[...document.querySelectorAll('button, input, select, a[href], [tabindex=\"0\"]')].filter((e) => e.tabIndex >= 0 && "
                   "!e.matches(':disabled, [type=radio]:not(:checked)') && e.checkVisibility()).length")
    assert len(stops) == wanted, f"the focus stops {len(stops)} times, of {wanted}"
    return len(stops)


def check(b):
    """All of it, of the page as it stands. Returns a sentence."""
    check_parts(b)
    check_sizes(b)
    return f"{check_names(b)} names, {check_contrast(b)} texts, {check_focus(b)} stops of the focus"
