"use strict";
// Sorts and filters tables, and draws one number over the frames.
document.documentElement.classList.add("scripted");

// The cell's number: all its digits, where fewer are shown.
const numberOf = (cell) => {
    const text = cell.title || cell.textContent;
    return text === "" ? NaN : Number(text);
};

const sortBy = (table, column) => {
    const head = table.tHead.rows[0].cells[column];
    const numeric = head.classList.contains("number");
    const ascending = head.getAttribute("aria-sort") !== "ascending";
    for (const other of table.tHead.rows[0].cells) other.removeAttribute("aria-sort");
    head.setAttribute("aria-sort", ascending ? "ascending" : "descending");
    const keyed = Array.from(table.tBodies[0].rows, (row) => {
        const cell = row.cells[column];
        return { row, key: numeric ? numberOf(cell) : cell.textContent };
    });
    const turn = ascending ? 1 : -1;
    keyed.sort((a, b) => {
        if (!numeric) return a.key === b.key ? 0 : a.key < b.key ? -turn : turn;
        // What is no number comes last either way.
        if (isNaN(a.key) || isNaN(b.key)) return isNaN(a.key) - isNaN(b.key);
        return turn * (a.key - b.key);
    });
    table.tBodies[0].append(...keyed.map(({ row }) => row));
};

const filter = (section) => {
    const words = section.querySelector(".filter").value.toLowerCase().split(/\s+/).filter(Boolean);
    const hide = section.querySelector(".hide")?.checked;
    const rows = section.querySelector("table").tBodies[0].rows;
    let shown = 0;
    for (const row of rows) {
        const text = Array.from(row.cells, (cell) => cell.textContent).join(" ").toLowerCase();
        const wanted = words.every((word) => text.includes(word));
        row.hidden = !wanted || (hide && row.classList.contains("zero"));
        shown += !row.hidden;
    }
    section.querySelector(".count").textContent = `${shown} of ${rows.length} rows`;
};

for (const table of document.querySelectorAll("table")) {
    table.classList.add("sorts");
    Array.from(table.tHead.rows[0].cells).forEach((head, column) => {
        head.tabIndex = 0;
        head.addEventListener("click", () => sortBy(table, column));
        head.addEventListener("keydown", (event) => {
            if (event.key === "Enter") sortBy(table, column);
        });
    });
    const section = table.closest("section");
    section.querySelectorAll(".tools input").forEach((input) => {
        input.addEventListener("input", () => filter(section));
    });
    filter(section);
}

const COLOURS = ["#4477aa", "#ee6677", "#228833", "#b58900", "#66a5c8", "#aa3377", "#888888"];

const element = (name, attributes, text) => {
    const made = document.createElementNS("http://www.w3.org/2000/svg", name);
    for (const key in attributes) made.setAttribute(key, attributes[key]);
    if (text !== undefined) made.textContent = text;
    return made;
};

// A step of 1, 2 or 5 times a power of ten, so that some five of them reach `most`.
const stepFor = (most) => {
    const power = 10 ** Math.floor(Math.log10(most / 5));
    return [1, 2, 5, 10].map((n) => n * power).find((step) => most / step <= 6);
};

const draw = (data, number, box) => {
    const [width, height, left, right, top, bottom] = [900, 380, 90, 130, 16, 40];
    const svg = element("svg", { viewBox: `0 0 ${width} ${height}`, role: "img" });
    svg.append(element("title", {}, number.name));
    const values = number.values.flat().filter((value) => value !== null);
    // As arguments of one call, many frames would not fit on the stack.
    const least = values.reduce((a, b) => Math.min(a, b), 0);
    const most = values.reduce((a, b) => Math.max(a, b), 0);
    const last = Math.max(1, data.frames.length - 1);
    const x = (frame) => left + (width - left - right) * frame / last;
    const tall = height - top - bottom;
    const y = (value) => height - bottom - tall * (value - least) / (most - least);
    const step = stepFor(most - least);
    for (let k = Math.ceil(least / step); k * step <= most; k++) {
        const at = y(k * step);
        svg.append(element("line", { class: "grid", x1: left, x2: width - right, y1: at, y2: at }));
        const text = Number((k * step).toPrecision(6)).toLocaleString("en");
        svg.append(element("text", { x: left - 8, y: at + 4, "text-anchor": "end" }, text));
    }
    const every = Math.max(1, Math.round(stepFor(last)));
    for (let frame = 0; frame <= last && frame < data.frames.length; frame += every) {
        const at = { x: x(frame), y: height - bottom + 18, "text-anchor": "middle" };
        svg.append(element("text", at, data.frames[frame]));
    }
    const middle = { x: (left + width - right) / 2, y: height - 4, "text-anchor": "middle" };
    svg.append(element("text", middle, "frame"));
    number.values.forEach((values, unit) => {
        const stroke = COLOURS[unit % COLOURS.length];
        // A line ends where there is no value.
        let points = [];
        const end = () => {
            const line = { points: points.join(" "), stroke };
            if (points.length) svg.append(element("polyline", line));
            points = [];
        };
        values.forEach((value, frame) => {
            if (value === null) end();
            else points.push(`${x(frame)},${y(value)}`);
        });
        end();
        if (!values.some((value) => value !== null)) return;
        const [at, from] = [top + 10 + 20 * unit, width - right + 14];
        const key = { class: "key", x1: from, x2: from + 20, y1: at, y2: at, stroke };
        svg.append(element("line", key));
        svg.append(element("text", { x: from + 26, y: at + 4 }, data.units[unit]));
    });
    box.replaceChildren(svg);
};

for (const section of document.querySelectorAll(".frames")) {
    const data = JSON.parse(section.querySelector(".data").textContent);
    const select = section.querySelector("select");
    data.numbers.forEach((number, index) => select.add(new Option(number.name, index)));
    const start = ["unit.cycles.total", "emit.triangles"];
    const found = start.map((name) => data.numbers.findIndex((number) => number.name === name));
    select.value = found.find((index) => index >= 0) ?? 0;
    const change = () => {
        const number = data.numbers[select.value];
        if (number) draw(data, number, section.querySelector(".plot"));
    };
    select.addEventListener("input", change);
    change();
}
