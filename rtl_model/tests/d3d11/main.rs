//! The tessellator: against vectors bit for bit, and what its patterns promise for every factor.

mod vectors;
