//! What a response depends on: derivatives by the logarithms of a model's parameters, how well sensors identify these, and where another sensor would add most.
//!
//! All of it is about the model as it is: nothing needs to be measured. From the subspace of a band (B-3) and the adjoint,
//! $$ \frac{\partial \ln x_m}{\partial \ln p} = -\frac{1}{x_m} z_m^T \frac{\partial D}{\partial \ln p} x, \qquad z_m = D^{-1} \ell_m. $$
//!
//! | file | contents |
//! |---|---|
//! | `variable` | which parameters a model has |
//! | `band` | response and derivatives over a band, with estimated errors |
//! | `resolved` | the scaled Jacobian of all sensors: its singular vectors, and error bars of any combination |
//! | `inseparable` | which parameters the sensors cannot separate |
//! | `next_sensor` | which other row lowers the worst error bar most |

mod band;
mod inseparable;
mod next_sensor;
mod resolved;
mod variable;

pub use band::{SensitivityBand, change_points};
pub use inseparable::{Inseparable, KNOWN_LN_STD, inseparable};
pub use next_sensor::{Ranked, VariableStd, WorstBar, next_sensors, with_each_added, worst_bar};
pub use resolved::{Resolved, StandardDeviations};
pub use variable::{Change, Variable};
