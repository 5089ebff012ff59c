//! Malformed attributes and primitives, as `text.rs` takes them. Words in capitals stand for what
//! [`spelt`] says.

/// A line, with what words in it stand for.
pub(crate) fn spelt(line: &str) -> String {
    let row: Vec<String> = (0..15).map(|k| k.to_string()).collect();
    let attribute = |k: i32| format!(r#"{{"name":"a{k}","format":"float32x4"}}"#);
    let sixteen: Vec<String> = (0..16).map(attribute).collect();
    line.replace("INDEXED", r#""primitive":"indexed_mesh","points":0"#)
        .replace("ID", r#""id":0"#)
        .replace("ROW", &row.join(","))
        .replace("SIXTEEN", &sixteen.join(","))
}

/// Lines after a header, a frame, and 16 points under the id 0.
pub(crate) const SURFACES: &[(&str, &str, &[&str])] = &[
    (
        "attributes without an id",
        r#"{"attributes":☞{"layout":[],"values":[]}}"#,
        &["attributes: `id` is missing"],
    ),
    (
        "attributes without a layout",
        r#"{"attributes":{ID,"layout":☞[],"values":[[1]]}}"#,
        &["attributes.layout: found []", "at least one attribute"],
    ),
    (
        "integer attributes",
        r#"{"attributes":{ID,"layout":[{"name":"a","format":☞"uint8x4"}],"values":[]}}"#,
        &["layout[0].format: found \"uint8x4\"", "did you mean \"unorm8x4\"?"],
    ),
    (
        "an attribute's name",
        r#"{"attributes":{ID,"layout":[{"name":☞"a b","format":"float32"}],"values":[]}}"#,
        &["layout[0].name: found \"a b\"", "letters, digits and underscores"],
    ),
    (
        "two attributes of a name",
        r#"{"attributes":{ID,"layout":[SIXTEEN,{"name":☞"a3","format":"unorm8"}],"values":[]}}"#,
        &["layout[16].name: found \"a3\"", "that no other attribute"],
    ),
    (
        "too many components",
        r#"{"attributes":{ID,"layout":[SIXTEEN,☞{"name":"b","format":"float32"}],"values":[]}}"#,
        &["layout[16]: found 65 components", "at most 64"],
    ),
    (
        "a corner short of a number",
        r#"{"attributes":{ID,"layout":[{"name":"a","format":"float32x3"}],"values":[☞[1,2]]}}"#,
        &["values[0]: found [1,2]", "the 3 numbers of a corner"],
    ),
    (
        "a corner with a number too many",
        r#"{"attributes":{ID,"layout":[{"name":"a","format":"float32"}],"values":[☞[1,2]]}}"#,
        &["values[0]: found [1,2]", "the 1 numbers of a corner"],
    ),
    (
        "unorm above 1",
        r#"{"attributes":{ID,"layout":[{"name":"a","format":"unorm8x2"}],"values":[[0.5,☞1.5]]}}"#,
        &["values[0][1]: found 1.5", "from 0 to 1, as unorm8x2 has"],
    ),
    (
        "attributes of no corner",
        r#"{"attributes":{ID,"layout":[{"name":"a","format":"float16"}],"values":☞[]}}"#,
        &["values: found []", "at least one corner"],
    ),
    (
        "strip of too few points",
        r#"{"draw":{"primitive":"strip","points":☞0,"count":9}}"#,
        &["draw.points", "expected at least 112 for 9 patches"],
    ),
    (
        "strip with rows",
        r#"{"draw":{"primitive":"strip","points":0,"count":1,☞"rows":1}}"#,
        &["found `rows`, which the primitive \"strip\" has not"],
    ),
    (
        "fan's encoding",
        r#"{"draw":{"primitive":"fan","points":0,"count":1,"encoding":☞"dense"}}"#,
        &["draw.encoding: found \"dense\"", "\"compact\", \"full\""],
    ),
    (
        "a mesh's encoding",
        r#"{"draw":{"primitive":"mesh","points":0,"rows":1,"columns":1,☞"encoding":"full"}}"#,
        &["found `encoding`, which the primitive \"mesh\" has not"],
    ),
    ("fan without a count", r#"{"draw":☞{"primitive":"fan","points":0}}"#, &["`count` is missing"]),
    (
        "indexed mesh without indices",
        r#"{"draw":☞{INDEXED}}"#,
        &["`indices` is missing", "16 integers a patch"],
    ),
    (
        "indexed mesh of nothing",
        r#"{"draw":{INDEXED,"indices":☞[]}}"#,
        &["draw.indices: found []", "at least one patch"],
    ),
    (
        "fifteen indices",
        r#"{"draw":{INDEXED,"indices":[☞[ROW]]}}"#,
        &["draw.indices[0]: found [0,1", "an array of 16 indices"],
    ),
    (
        "a negative index",
        r#"{"draw":{INDEXED,"indices":[[ROW,☞-1]]}}"#,
        &["draw.indices[0][15]: found -1", "from 0 to 65535"],
    ),
    (
        "a wide index in a narrow format",
        r#"{"draw":{INDEXED,"index_format":"uint16","indices":[[☞65536,1,ROW]]}}"#,
        &["found 65536", "from 0 to 65535"],
    ),
    (
        "an index beyond the points",
        r#"{"draw":{"primitive":"indexed_mesh","points":☞0,"indices":[[ROW,999]]}}"#,
        &["draw.points", "expected at least 1000 for the index 999"],
    ),
    (
        "index format of one byte",
        r#"{"draw":{INDEXED,"index_format":☞"uint8","indices":[]}}"#,
        &["draw.index_format: found \"uint8\"", "\"uint16\", \"uint32\""],
    ),
    (
        "indices without an indexed mesh",
        r#"{"draw":{"primitive":"patches","points":0,"count":1,☞"indices":[]}}"#,
        &["found `indices`, which the primitive \"patches\" has not"],
    ),
    (
        "corners without attributes",
        r#"{"draw":{INDEXED,"indices":[[ROW,15]],☞"attribute_indices":[[0,1,2,3]]}}"#,
        &["found `attribute_indices`, which go with `attributes`"],
    ),
    (
        "unknown attributes",
        r#"{"draw":{"primitive":"patches","points":0,"count":1,"attributes":☞7}}"#,
        &["draw.attributes: found 7", "the id of attributes (none so far)"],
    ),
];
