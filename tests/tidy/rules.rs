//! The rules that one file keeps by itself.

use crate::lexer::{self, Token};

const LINES_MAX: usize = 500;
const COLUMNS_MAX: usize = 100;

/// The files that may be unsafe: one calls the C++ that Verilator makes of the hardware, one a
/// driver's OpenGL.
const BOUNDARIES_TO_C: [&str; 2] = ["rtl_model/tests/lockstep/verilated.rs", "tests/driver/gl.rs"];

/// What is wrong with the Rust file at `path`.
pub(crate) fn problems(path: &str, text: &str) -> Vec<String> {
    let tokens = lexer::tokens(text);
    let mut problems = shape(path, text);
    problems.extend(forbidden_anywhere(path, &tokens));
    if path.starts_with("rtl_model/src/") && !path.ends_with("/tests.rs") {
        problems.extend(forbidden_in_hardware(path, &lexer::without_tests(&tokens)));
    }
    problems
}

fn shape(path: &str, text: &str) -> Vec<String> {
    let mut problems = Vec::new();
    let lines = text.lines().count();
    if lines > LINES_MAX {
        problems.push(format!("{path}: {lines} lines, at most {LINES_MAX}"));
    }
    if !text.starts_with("//!") {
        problems.push(format!("{path}:1: begins without `//!`"));
    }
    let table = counter_table(path, text);
    for (number, line) in (1..).zip(text.lines()) {
        let columns = line.chars().count();
        if columns > COLUMNS_MAX && !table.contains(&number) {
            problems.push(format!("{path}:{number}: {columns} columns, at most {COLUMNS_MAX}"));
        }
    }
    problems
}

/// What is wrong with the kernel at `path`: the same shape, and no numbers but integers of 32 bits,
/// but where pictures are drawn.
pub(crate) fn kernel_problems(path: &str, text: &str) -> Vec<String> {
    let mut problems = Vec::new();
    let lines = text.lines().count();
    if lines > LINES_MAX {
        problems.push(format!("{path}: {lines} lines, at most {LINES_MAX}"));
    }
    if !text.starts_with("// ") {
        problems.push(format!("{path}:1: begins without a comment that says what it is"));
    }
    let draws = path.starts_with("src/gpu/render/");
    for (number, line) in (1..).zip(text.lines()) {
        let columns = line.chars().count();
        if columns > COLUMNS_MAX {
            problems.push(format!("{path}:{number}: {columns} columns, at most {COLUMNS_MAX}"));
        }
        let code = line.split("//").next().unwrap_or_default();
        let mut words = code.split(|c: char| !c.is_alphanumeric() && c != '_');
        let wide = words.find(|word| ["f32", "f16", "i64", "u64"].contains(word));
        if let (Some(word), false) = (wide, draws) {
            problems.push(format!("{path}:{number}: {word}: integers of 32 bits only"));
        }
    }
    problems
}

/// The one exemption from the width of lines: the table of counters has a line a counter, which
/// reads and diffs better than what would come of wrapping it.
fn counter_table(path: &str, text: &str) -> std::ops::Range<usize> {
    if path != "rtl_model/src/counter.rs" {
        return 0..0;
    }
    // The macro that the table goes through, which names all columns in one line, stands above it.
    let line_of = |wanted: &str| (1..).zip(text.lines()).find(|(_, line)| *line == wanted);
    match (line_of("macro_rules! counters {"), line_of("/// How many counters there are.")) {
        (Some((first, _)), Some((last, _))) => first..last,
        _ => 0..0,
    }
}

fn forbidden_anywhere(path: &str, tokens: &[Token<'_>]) -> Vec<String> {
    const FORBIDDEN: [(&[&str], &str); 5] = [
        (&["todo", "!"], "unfinished work belongs in no commit"),
        (&["unimplemented", "!"], "unfinished work belongs in no commit"),
        (&["dbg", "!"], "left over from debugging"),
        (&["#", "[", "ignore"], "a test that cannot run says SKIPPED and why"),
        (&["unsafe"], "a boundary to C is the only reason, and has its file"),
    ];
    let mut problems = Vec::new();
    for (at, token) in tokens.iter().enumerate() {
        for (texts, reason) in FORBIDDEN {
            let boundary = texts == ["unsafe"] && BOUNDARIES_TO_C.contains(&path);
            if lexer::begins(&tokens[at..], texts) && !boundary {
                problems.push(format!("{path}:{}: {}: {reason}", token.line, texts.concat()));
            }
        }
    }
    problems
}

/// The hardware is integers and nothing else: no floating point, no system.
fn forbidden_in_hardware(path: &str, tokens: &[Token<'_>]) -> Vec<String> {
    let mut problems = Vec::new();
    for (at, token) in tokens.iter().enumerate() {
        let text = token.text;
        let number = text.starts_with(|c: char| c.is_ascii_digit());
        // Hexadecimal digits include f: 0x1f32 is an integer.
        let float = match number && !text.starts_with("0x") {
            true => fraction(at, tokens) || text.ends_with("f32") || text.ends_with("f64"),
            false => text == "f32" || text == "f64",
        };
        if float {
            problems.push(format!("{path}:{}: {text}: no floating point here", token.line));
        }
    }
    const SYSTEM: [&str; 6] = ["fs", "thread", "net", "env", "process", "time"];
    for (module, line) in crate::arrows::paths(tokens, "std") {
        if SYSTEM.contains(&module) {
            problems.push(format!("{path}:{line}: std::{module}: no system here"));
        }
    }
    problems
}

/// `1.5`, but not the fields of `x.1.0`.
fn fraction(at: usize, tokens: &[Token<'_>]) -> bool {
    let field = at > 0 && tokens[at - 1].text == ".";
    tokens[at].text.contains('.') && !field
}

/// Absolute paths of somebody's machine in any text.
pub(crate) fn machine_paths(path: &str, text: &str) -> Vec<String> {
    // In two parts, so that this file passes its own rule.
    let places = [("/ho", "me/"), ("/ro", "ot/"), ("/tm", "p/"), ("/wo", "rk/"), ("/Us", "ers/")];
    let mut problems = Vec::new();
    for (number, line) in (1..).zip(text.lines()) {
        for place in places.map(|(a, b)| format!("{a}{b}")) {
            let absolute = line.match_indices(&place).any(|(at, _)| {
                // Within a longer path or address it is somebody else's folder of that name.
                !line[..at].ends_with(|c: char| c.is_alphanumeric() || "._-~}".contains(c))
            });
            if absolute {
                problems.push(format!("{path}:{number}: a path under {place}"));
            }
        }
    }
    problems
}
