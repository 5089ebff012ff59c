//! What was compared, how much of it differs, and the first differences.

/// Differences of a row that are kept.
const KEPT: usize = 3;

/// One value that differs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Difference {
    /// Which item: a patch, and where in it.
    pub place: String,
    /// What both were given.
    pub inputs: String,
    /// The first implementation's words.
    pub cpu: Vec<u32>,
    /// The second's.
    pub gpu: Vec<u32>,
}

/// What was compared of a block.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Row {
    /// The block.
    pub block: &'static str,
    /// What of it.
    pub what: &'static str,
    /// Words compared.
    pub values: u64,
    /// Words that differ.
    pub different: u64,
    /// The first of them.
    pub first: Vec<Difference>,
}

/// The rows of a comparison, in the order in which they came.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Ledger {
    rows: Vec<Row>,
    stops: bool,
}

impl Ledger {
    /// One that panics at the first difference, for who asks only whether there is any.
    #[must_use]
    pub fn stopping() -> Self {
        Self { stops: true, ..Self::default() }
    }

    /// The rows.
    #[must_use]
    pub fn rows(&self) -> &[Row] {
        &self.rows
    }

    /// Words compared, and words that differ.
    #[must_use]
    pub fn totals(&self) -> [u64; 2] {
        self.rows.iter().fold([0, 0], |[a, b], row| [a + row.values, b + row.different])
    }

    /// Compares the words of one item. A missing or surplus word is a difference; `place` and
    /// `inputs` are asked for only where there is one.
    ///
    /// # Panics
    ///
    /// At a difference, if it is to stop there.
    pub fn compare(
        &mut self,
        (block, what): (&'static str, &'static str),
        cpu: &[u32],
        gpu: &[u32],
        place: impl FnOnce() -> String,
        inputs: impl FnOnce() -> String,
    ) {
        let found = self.rows.iter().rposition(|row| row.block == block && row.what == what);
        let at = found.unwrap_or_else(|| {
            self.rows.push(Row { block, what, values: 0, different: 0, first: Vec::new() });
            self.rows.len() - 1
        });
        let row = &mut self.rows[at];
        row.values += cpu.len() as u64;
        if cpu == gpu {
            return;
        }
        assert!(!self.stops, "{block} {what}: {}: cpu {cpu:08x?} gpu {gpu:08x?}", place());
        let unequal = cpu.iter().zip(gpu).filter(|(a, b)| a != b).count();
        row.different += (unequal + cpu.len().abs_diff(gpu.len())) as u64;
        if row.first.len() < KEPT {
            row.first.push(Difference {
                place: place(),
                inputs: inputs(),
                cpu: cpu.to_vec(),
                gpu: gpu.to_vec(),
            });
        }
    }
}
