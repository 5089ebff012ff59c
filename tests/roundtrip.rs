//! What the writer writes, the reader reads: the same commands, to the bit, for random traces.

#[path = "support/commands.rs"]
mod commands;

use commands::trace;
use proptest::prelude::*;
use tessim::trace::command::Command;
use tessim::trace::read::Reader;
use tessim::trace::write::Writer;

proptest! {
    #[test]
    fn reading_undoes_writing(commands in trace()) {
        let mut writer = Writer::new(Vec::new());
        for command in &commands {
            writer.write(command).expect("memory takes all");
        }
        let text = writer.into_inner();
        let read: Result<Vec<Command>, _> =
            Reader::new(&text[..], "t", ".").map(|c| c.map(|c| c.command)).collect();
        let read = read.expect("what is written is well-formed");
        prop_assert_eq!(read.len(), commands.len());
        prop_assert_eq!(&read, &commands);
        // Equality takes -0 for 0; what is shown does not.
        prop_assert_eq!(format!("{read:?}"), format!("{commands:?}"));
    }
}
