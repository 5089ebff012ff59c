//! Sums over patches: of so many rows that every stretch of the scan has some, and of values whose
//! sum has more than 32 bits.

use crate::random::Random;
use crate::support;
use crate::table::Quantity;
use tessim::gpu::{Kernel, words};

/// Words of a row, and the column that is scanned.
const ROW: usize = 5;
const COLUMN: usize = 3;

#[test]
fn sums_are_those_of_the_rows() {
    let Some(device) = support::device() else { return };
    let mut ledger = support::ledger();
    let mut random = Random::new(73);
    for count in [1, 2, 63, 64, 65, 127, 1000, 4096, 4159, 4160, 9999, 32_768] {
        let any: Vec<u32> = (0..ROW * count).map(|_| random.bits() as u32).collect();
        let small: Vec<u32> = any.iter().map(|word| word & 0xffff).collect();
        let column = |rows: &[u32], k: usize| -> Vec<u32> {
            rows.iter().skip(k).step_by(ROW).copied().collect()
        };
        let mut settings = support::settings(32).of(64);
        settings.own[..3].copy_from_slice(&[count as u32, ROW as u32, COLUMN as u32]);
        let rows = device.upload(&small).unwrap();
        let out = device.empty(count + 1).unwrap();
        device.run(Kernel::Scan, "scan", &settings, &[&rows, &out]).unwrap();
        let mut before = 0;
        let mut want = vec![0];
        want.extend(column(&small, COLUMN).iter().map(|word| {
            before += word;
            before
        }));
        let got = device.read(&out, 0, count + 1).unwrap();
        let place = || format!("{count} rows");
        ledger.compare(("scan", "starts"), &want, &got, place, String::new);
        let rows = device.upload(&any).unwrap();
        let sums = device.empty(2 * ROW).unwrap();
        device.run(Kernel::Scan, "columns", &settings.of(ROW), &[&rows, &sums]).unwrap();
        let sum = |k: usize| -> i64 { column(&any, k).iter().map(|&w| i64::from(w)).sum() };
        let want: Vec<u32> = (0..ROW).flat_map(|k| words(sum(k))).collect();
        let got = device.read(&sums, 0, 2 * ROW).unwrap();
        ledger.compare(("scan", "columns"), &want, &got, place, String::new);
    }
    support::settle(&ledger, Quantity::KernelScan);
}
