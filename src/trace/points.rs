//! To come: where points live.
#[derive(Debug)]
pub enum PointSource {}
