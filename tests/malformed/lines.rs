//! Malformed lines, as `text.rs` takes them: a hand, `☞`, stands before the byte of the error.

/// Lines after a header, a frame, and 16 points under the id 0.
pub(crate) const LINES: &[(&str, &str, &[&str])] = &[
    ("blank line", "☞", &["blank line"]),
    ("line of spaces", "☞   ", &["blank line"]),
    (
        "unknown command",
        r#"{☞"darw":{}}"#,
        &["unknown command \"darw\"", "did you mean `draw`?", "`tessellation`"],
    ),
    (
        "unlike any command",
        r#"{☞"xyzzy":{}}"#,
        &["unknown command \"xyzzy\", expected one of `frame`, `points`"],
    ),
    ("two commands", r#"{"end":{},☞"draw":{}}"#, &["found \"draw\"", "one command"]),
    ("two objects", r#"{"end":{}} ☞{"end":{}}"#, &["after the command", "end of the line"]),
    ("draw is no object", r#"{"draw":☞[]}"#, &["draw: found []", "expected an object"]),
    ("missing comma", r#"{"draw":{"points":0 ☞"count":1}}"#, &["not JSON", "expected `,` or `}`"]),
    (
        "trailing comma",
        r#"{"draw":{"points":0,☞}}"#,
        &["not JSON: found `}` after a comma", "another field"],
    ),
    (
        "trailing comma in a list",
        r#"{"frame":{"viewport":[1,2,☞]}}"#,
        &["not JSON: found `]`, expected a value"],
    ),
    ("single quotes", r#"{☞'draw':{}}"#, &["not JSON: key must be a string"]),
    ("NaN", r#"{"points":{"id":1,"xyz":[[☞NaN,0,0]]}}"#, &["`NaN`", "JSON has no NaN"]),
    ("leading zero", r#"{"points":{"id":0☞1}}"#, &["not JSON: invalid number"]),
    (
        "viewport of 0",
        r#"{"frame":{"viewport":[1280,☞0]}}"#,
        &["frame.viewport[1]: found 0", "1 to 16384"],
    ),
    (
        "viewport too large",
        r#"{"frame":{"viewport":[☞16385,1]}}"#,
        &["viewport[0]: found 16385", "1 to 16384"],
    ),
    (
        "fractional viewport",
        r#"{"frame":{"viewport":[☞1.5,1]}}"#,
        &["found 1.5", "an integer from 1"],
    ),
    (
        "viewport of one side",
        r#"{"frame":{"viewport":☞[640]}}"#,
        &["found [640]", "[width, height]"],
    ),
    (
        "viewport of three",
        r#"{"frame":{"viewport":[1,2,☞3]}}"#,
        &["viewport[2]: found 3", "width and height"],
    ),
    (
        "frame without a view",
        r#"{"frame":☞{"viewport":[640,480]}}"#,
        &["frame: `view` is missing", "16 numbers"],
    ),
    (
        "short matrix",
        r#"{"frame":{"viewport":[1,1],"view":☞[1,2,3]}}"#,
        &["frame.view: found [1,2,3]", "16 numbers", "not 3"],
    ),
    (
        "long matrix",
        r#"{"frame":{"viewport":[1,1],"view":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1,☞9]}}"#,
        &["frame.view[16]: found 9", "16"],
    ),
    (
        "matrix of text",
        r#"{"frame":{"viewport":[1,1],"view":[☞"1",0]}}"#,
        &["frame.view[0]: found \"1\"", "a finite number"],
    ),
    (
        "singular view",
        r#"{"frame":{"viewport":[1,1],"view":☞[1,0,0,0,0,1,0,0,0,0,0,0,0,0,0,1]}}"#,
        &["frame.view: found [1,0,", "singular"],
    ),
    (
        "singular projection",
        concat!(
            r#"{"frame":{"projection":☞[0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,9],"#,
            r#""viewport":[1,1],"view":ONE}}"#
        ),
        &["frame.projection", "singular"],
    ),
    (
        "unknown depth",
        r#"{"frame":{"viewport":[1,1],"view":ONE,"projection":ONE,"depth":☞"zero_to_two"}}"#,
        &[
            "frame.depth: found \"zero_to_two\"",
            "\"minus_one_to_one\"",
            "did you mean \"zero_to_one\"?",
        ],
    ),
    (
        "range that is no power of two",
        r#"{"frame":{"viewport":[1,1],"view":ONE,"projection":ONE,"range":{"clip":☞12}}}"#,
        &["frame.range.clip: found 12", "power of two"],
    ),
    (
        "range out of bounds",
        r#"{"frame":{"viewport":[1,1],"view":ONE,"projection":ONE,"range":{"object":☞4e19}}}"#,
        &["range.object: found 4e19", "2^64"],
    ),
    (
        "unknown range",
        r#"{"frame":{"viewport":[1,1],"view":ONE,"projection":ONE,"range":{☞"clipp":1}}}"#,
        &["range.clipp", "did you mean `clip`?"],
    ),
    ("points without an id", r#"{"points":☞{"xyz":[[0,0,0]]}}"#, &["points: `id` is missing"]),
    (
        "negative id",
        r#"{"points":{"id":☞-1,"xyz":[[0,0,0]]}}"#,
        &["points.id: found -1", "0 to 4294967295"],
    ),
    (
        "id of 33 bits",
        r#"{"points":{"id":☞4294967296,"xyz":[[0,0,0]]}}"#,
        &["points.id: found 4294967296"],
    ),
    (
        "null points",
        r#"{"points":{"id":1,"xyz":☞null}}"#,
        &["points.xyz: found null", "array of points"],
    ),
    (
        "no points at all",
        r#"{"points":☞{"id":1}}"#,
        &["points are missing", "`xyz`, `xyzw` or `file`"],
    ),
    (
        "empty points",
        r#"{"points":{"id":1,"xyz":☞[]}}"#,
        &["points.xyz: found []", "at least one point"],
    ),
    (
        "both kinds of points",
        r#"{"points":☞{"id":1,"xyz":[[0,0,0]],"xyzw":[[0,0,0,1]]}}"#,
        &["several of `xyz`, `xyzw` and `file`"],
    ),
    (
        "short point",
        r#"{"points":{"id":1,"xyz":[[0,0,0],☞[1,2]]}}"#,
        &["points.xyz[1]: found [1,2]", "[x, y, z]"],
    ),
    (
        "long point",
        r#"{"points":{"id":1,"xyz":[☞[1,2,3,4]]}}"#,
        &["points.xyz[0]: found [1,2,3,4]", "[x, y, z]"],
    ),
    (
        "flat points",
        r#"{"points":{"id":1,"xyz":[☞1,2,3]}}"#,
        &["points.xyz[0]: found 1", "a point [x, y, z]"],
    ),
    (
        "overflow of 32 bits",
        r#"{"points":{"id":1,"xyz":[[0,0,0],[0,☞1e39,0]]}}"#,
        &["points.xyz[1][1]: found 1e39", "finite number within 32-bit"],
    ),
    (
        "overflow of 64 bits",
        r#"{"points":{"id":1,"xyz":[[☞-1e999,0,0]]}}"#,
        &["points.xyz[0][0]: found -1e999", "finite"],
    ),
    (
        "coordinate as text",
        r#"{"points":{"id":1,"xyz":[[0,☞"1",0]]}}"#,
        &["points.xyz[0][1]: found \"1\"", "a finite number"],
    ),
    (
        "null coordinate",
        r#"{"points":{"id":1,"xyz":[[0,0,☞null]]}}"#,
        &["points.xyz[0][2]: found null"],
    ),
    (
        "zero weight",
        r#"{"points":{"id":1,"xyzw":[[0,0,0,1],[0,0,0,☞0]]}}"#,
        &["points.xyzw[1][3]: found 0", "a weight above 0"],
    ),
    (
        "negative weight",
        r#"{"points":{"id":1,"xyzw":[[0,0,0,☞-1]]}}"#,
        &["found -1", "weight above 0"],
    ),
    (
        "resident is a number",
        r#"{"points":{"id":1,"xyz":[[0,0,0]],"resident":☞1}}"#,
        &["points.resident: found 1", "true or false"],
    ),
    (
        "field twice",
        r#"{"points":{"id":1,☞"id":2,"xyz":[[0,0,0]]}}"#,
        &["points.id: the field `id` is given twice"],
    ),
    (
        "count of inline points",
        r#"{"points":{"id":1,"xyz":[[0,0,0]],☞"count":1}}"#,
        &["points.count", "`file`"],
    ),
    (
        "unknown criterion",
        r#"{"tessellation":{"criterion":☞"flat"}}"#,
        &[
            "tessellation.criterion: found \"flat\"",
            "\"edge_length\", \"fixed\"",
            "did you mean \"flatness\"?",
        ],
    ),
    (
        "flatness without pixels",
        r#"{"tessellation":☞{"criterion":"flatness"}}"#,
        &["tessellation: `pixels` is missing"],
    ),
    (
        "no pixels",
        r#"{"tessellation":{"criterion":"flatness","pixels":☞0}}"#,
        &["pixels: found 0", "above 0"],
    ),
    (
        "fixed without a level",
        r#"{"tessellation":☞{"criterion":"fixed"}}"#,
        &["`level` is missing", "1 to 128"],
    ),
    (
        "fixed with pixels",
        r#"{"tessellation":{"criterion":"fixed",☞"pixels":1,"level":2}}"#,
        &["tessellation.pixels", "\"fixed\" has not"],
    ),
    (
        "level without fixed",
        r#"{"tessellation":{☞"level":2}}"#,
        &["tessellation.level", "only the criterion \"fixed\""],
    ),
    (
        "level below 1",
        r#"{"tessellation":{"criterion":"fixed","level":☞0.5}}"#,
        &["level: found 0.5", "from 1 to 128"],
    ),
    (
        "level above 128",
        r#"{"tessellation":{"max_level":☞128.5}}"#,
        &["max_level: found 128.5", "from 1 to 128"],
    ),
    (
        "levels crossed",
        r#"{"tessellation":{"min_level":☞9,"max_level":8.5}}"#,
        &["min_level: found 9", "at most max_level, which is 8.5"],
    ),
    (
        "least level above the default",
        r#"{"tessellation":{"min_level":☞65}}"#,
        &["at most max_level, which is 64"],
    ),
    (
        "unknown primitive",
        r#"{"draw":{"primitive":☞"patch","points":0,"count":1}}"#,
        &["draw.primitive: found \"patch\"", "did you mean \"patches\"?"],
    ),
    (
        "draw without a primitive",
        r#"{"draw":☞{"points":0,"count":1}}"#,
        &["draw: `primitive` is missing"],
    ),
    (
        "draw without points",
        r#"{"draw":☞{"primitive":"patches","count":1}}"#,
        &["draw: `points` is missing"],
    ),
    (
        "unknown id",
        r#"{"draw":{"primitive":"patches","points":☞7,"count":1}}"#,
        &["draw.points: found 7", "the id of points (0)"],
    ),
    ("no count", r#"{"draw":☞{"primitive":"patches","points":0}}"#, &["draw: `count` is missing"]),
    (
        "count of 0",
        r#"{"draw":{"primitive":"patches","points":0,"count":☞0}}"#,
        &["draw.count: found 0", "from 1 to 16777216"],
    ),
    (
        "count too large",
        r#"{"draw":{"primitive":"patches","points":0,"count":☞16777217}}"#,
        &["draw.count: found 16777217"],
    ),
    (
        "too few points",
        r#"{"draw":{"primitive":"patches","points":☞0,"count":2}}"#,
        &["draw.points: found 16 points under id 0", "at least 32", "2 patches"],
    ),
    (
        "too few behind first",
        r#"{"draw":{"primitive":"patches","points":☞0,"count":1,"first":1}}"#,
        &["16 points", "from point 1 on"],
    ),
    (
        "first overflows",
        r#"{"draw":{"primitive":"patches","points":☞0,"count":1,"first":18446744073709551615}}"#,
        &["found 16 points", "from point 18446744073709551615 on"],
    ),
    (
        "negative first",
        r#"{"draw":{"primitive":"patches","points":0,"count":1,"first":☞-1}}"#,
        &["draw.first: found -1", "an integer from 0"],
    ),
    (
        "mesh too large",
        r#"{"draw":{"primitive":"mesh","points":0,"rows":8192,"columns":☞8192}}"#,
        &["8192 rows of 8192 patches", "at most 16777216"],
    ),
    (
        "mesh with a count",
        r#"{"draw":{"primitive":"mesh","points":0,"rows":1,"columns":1,☞"count":1}}"#,
        &["draw.count", "\"mesh\" has not"],
    ),
    (
        "mesh of 2 rows",
        r#"{"draw":{"primitive":"mesh","points":☞0,"rows":2,"columns":1}}"#,
        &["16 points", "at least 28"],
    ),
    (
        "patches with rows",
        r#"{"draw":{"primitive":"patches","points":0,"count":1,☞"rows":1}}"#,
        &["draw.rows", "\"patches\" has not"],
    ),
    (
        "no instances",
        r#"{"draw":{"primitive":"patches","points":0,"count":1,"instances":☞[]}}"#,
        &["draw.instances: found []", "at least one"],
    ),
    (
        "model and instances",
        r#"{"draw":{"primitive":"patches","points":0,"count":1,☞"model":ONE,"instances":[ONE]}}"#,
        &["draw.model", "`instances` excludes"],
    ),
    (
        "infinite model",
        r#"{"draw":{"primitive":"patches","points":0,"count":1,"instances":[ONE,[1,☞1e39]]}}"#,
        &["draw.instances[1][1]: found 1e39"],
    ),
    (
        "unknown front",
        r#"{"draw":{"primitive":"patches","points":0,"count":1,"front":☞"back"}}"#,
        &["draw.front: found \"back\"", "\"reversed\""],
    ),
    (
        "cull as text",
        r#"{"draw":{"primitive":"patches","points":0,"count":1,"cull":☞"no"}}"#,
        &["draw.cull: found \"no\"", "true or false"],
    ),
    (
        "misspelt field",
        r#"{"draw":{"primitive":"patches","points":0,☞"cuont":1}}"#,
        &["draw.cuont", "did you mean `count`?"],
    ),
    (
        "line cut short",
        r#"{"draw":{"primitive":"pat☞"#,
        &["not JSON: the line ends inside a string"],
    ),
];
