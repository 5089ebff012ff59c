//! The configuration as TOML for people: each key under a comment with its meaning, unit and range.
//!
//! Keys that are absent are printed as comments that say what holds without them. Reading the text
//! back gives the same configuration: that is what makes a result folder reproducible.

use super::{Config, keys};
use std::fmt::Write;
use toml::{Table, Value};

impl Config {
    /// Commented TOML with every key.
    #[must_use]
    pub fn to_commented_toml(&self) -> String {
        let table = Table::try_from(self).expect("a configuration is plain data");
        let mut text = String::new();
        let mut open = "";
        for key in keys::KEYS {
            let (section, name) = key.path.rsplit_once('.').unwrap_or(("", key.path));
            if section != open {
                write!(text, "\n[{section}]\n").expect("a String takes everything");
                open = section;
            }
            let value = lookup(&table, key.path);
            entry(&mut text, key, name, value);
        }
        text
    }

    /// The value at a dotted path; none for a key that is absent.
    #[must_use]
    pub fn value(&self, path: &str) -> Option<Value> {
        let table = Table::try_from(self).expect("a configuration is plain data");
        lookup(&table, path).cloned()
    }
}

fn lookup<'a>(table: &'a Table, path: &str) -> Option<&'a Value> {
    match path.split_once('.') {
        None => table.get(path),
        Some((section, rest)) => lookup(table.get(section)?.as_table()?, rest),
    }
}

fn entry(text: &mut String, key: &keys::Key, name: &str, value: Option<&Value>) {
    let (meaning, expected) = (key.meaning, key.expected);
    match (value, key.absent) {
        (Some(value), _) => write!(text, "# {meaning}: {expected}\n{name} = {value}\n"),
        (None, Some((example, without))) => {
            write!(text, "# {meaning}: {expected}; absent: {without}\n# {name} = {example}\n")
        }
        (None, None) => unreachable!("only optional keys are absent"),
    }
    .expect("a String takes everything");
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::layers::Layers;
    use crate::config::preset::Preset;
    use crate::config::{Bus, Channels, Criterion, Engine, Frames, LaneOrder, TransferMode};

    fn reread(text: &str) -> Config {
        // Over another preset: every key that matters must be in the text.
        let mut layers = Layers::new(Preset::Gf3_2001);
        layers.file("printed.toml", text).unwrap();
        layers.finish().unwrap()
    }

    #[test]
    fn what_is_printed_reads_back_as_the_same_configuration() {
        let mut config = Preset::Modern.config();
        assert_eq!(reread(&config.to_commented_toml()), config.effective());
        config.level.pixels = Some(0.1);
        config.level.criterion = Some(Criterion::EdgeLength);
        config.level.near = Some(1e-9);
        config.position.clip_range_log2 = Some(-3);
        config.evaluate.guard = Some(7);
        config.engine = Engine::Stepped;
        config.link.transfer = TransferMode::Pull;
        config.memory.channels = Channels::Shared;
        config.frames = Frames::Overlap;
        config.block.clip.in_flight = Some(9);
        config.block.backface.latency = Some(7);
        config.block.evaluate.setup = 3;
        config.block.evaluate.costs.lanes = 2;
        config.block.emit.lane_order = LaneOrder::RoundRobin;
        assert_eq!(reread(&config.to_commented_toml()), config.effective());
        for bus in Bus::all() {
            config.link.take(bus);
            assert_eq!(reread(&config.to_commented_toml()), config.effective());
            config.link.request = 100;
            assert_eq!(reread(&config.to_commented_toml()), config.effective());
        }
    }

    #[test]
    fn every_key_is_printed_once_and_examples_can_be_uncommented() {
        let text = Config::default().to_commented_toml();
        let plain = text.lines().filter(|line| !line.is_empty() && !line.starts_with('['));
        assert_eq!(plain.count(), 2 * keys::KEYS.len());
        // All but level.level, which contradicts level.pixels.
        let text = text.replace("# level =", "#level =");
        let uncommented: String = text
            .lines()
            .map(|line| match line.strip_prefix("# ") {
                Some(rest) if rest.contains(" = ") => format!("{rest}\n"),
                _ => format!("{line}\n"),
            })
            .collect();
        let config = reread(&uncommented);
        assert_eq!(config.level.criterion, Some(Criterion::Flatness));
        assert_eq!(config.position.clip_range_log2, Some(4));
        assert_eq!(config.block.backface.interval, Some(81));
    }
}
