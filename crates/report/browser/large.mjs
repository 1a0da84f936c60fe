// node large.mjs FOLDER: results of 10,000 frequencies and 8 sensors in the form of frfit identify, made of formulas.
import { mkdir, writeFile } from "node:fs/promises";
import { join } from "node:path";

const folder = process.argv[2];
const [COUNT, SENSORS] = [10_000, 8];
const frequencies = Array.from({ length: COUNT }, (_, k) => 10 + 0.1 * k);

/** Receptance of three modes with a stiffness s times the nominal one. */
function receptance(frequency, s, loss, sensor) {
  let [re, im] = [0, 0];
  [120, 410, 790].forEach((mode, k) => {
    const stiffness = s * mode ** 2;
    const [a, b] = [stiffness - frequency ** 2, stiffness * loss];
    const weight = Math.cos((sensor + 1) * (k + 1)) / (a * a + b * b);
    re += weight * a;
    im -= weight * b;
  });
  return [re, im];
}

const identified = ["frequency_hz,storage,loss_factor,factor_re,factor_im,correction_re,correction_im,error,spectral_radius,order,candidate_count,status,convergence_radius,required_order,reduction_error,storage_std,loss_factor_std,storage_loss_correlation,storage_std_noise,storage_std_model,storage_std_known_factors,chi2"];
const reference = ["frequency_hz,nominal_re,nominal_im,true_re,true_im"];
const response = ["frequency_hz,sensor,quantity,nominal_re,nominal_im,measured_re,measured_im,updated_re,updated_im,measured_std"];
const candidates = ["frequency_hz,storage,loss_factor,correction_re,correction_im,verdict"];
const statuses = { ok: 0, ambiguous: 0, no_root: 0, not_identifiable: 0 };
frequencies.forEach((f, k) => {
  const [storage, loss] = [1e6 * (1 + 0.4 * Math.log(f)), 0.2 + 0.02 * Math.sin(f / 90)];
  const status = k % 997 < 30 ? "not_identifiable" : k % 1999 === 5 ? "no_root" : k % 499 < 9 ? "ambiguous" : "ok";
  statuses[status] += 1;
  const noise = 1e-3 * Math.sin(k * k);
  const answer = status === "no_root" ? ",,,,,," : [storage * (1 + noise), loss * (1 - noise), storage, storage * loss, storage - 2e6, storage * loss - 2e5, Math.abs(noise)].join(",");
  identified.push(`${f},${answer},${0.5 + 0.4 * Math.sin(f / 50)},30,3,${status},0.8,${10 + (k % 40)},1e-8,${1e-3 * storage},${1e-3 * loss},0.1,${1e-3 * storage},0,0,${1 + noise}`);
  reference.push(`${f},2000000.0,200000.0,${storage},${storage * loss}`);
  for (let m = 0; m < SENSORS; m++) {
    const [nominal, updated] = [receptance(f, 0.5, 0.1, m), receptance(f, 1, loss, m)];
    const measured = updated.map((value) => value * (1 + 5 * noise));
    response.push(`${f},S${m + 1},receptance,${nominal.join(",")},${measured.join(",")},${updated.join(",")},${1e-3 * Math.hypot(...updated)}`);
  }
  candidates.push(`${f},${storage},${loss},0,0,chosen`, `${f},${3 * storage},${loss},0,0,admissible`, `${f},${9 * storage},${-loss},0,0,loss_factor`);
});
const summary = {
  frfit: "0.1.0", title: "Large: 10,000 frequencies and 8 sensors <script>alert(1)</script>", inputs: [], model: { dofs: 100000, nonzeros: 7000000, matrices: [{ name: "K", role: "stiffness" }] },
  sensors: Array.from({ length: SENSORS }, (_, m) => ({ label: `S${m + 1}`, quantity: "receptance", contradicts: false, left_out: false, misfit: 1 })),
  identify: { method: "rational", selection: "joint", band_hz: [10, 1010] },
  unknowns: [{ name: "K", matrices: ["K"], unit: "Pa", varies: "frequency", real: false, numbers: null, status: null, reference: null }],
  coordinates: [], correlation: [], directions: [], not_identifiable: [], profile: null, search: { converged: true },
  status: statuses, frequencies: COUNT, findings: [], fit: { verdict: "explained", chi2_per_freedom: 1.01, freedom: 1000 }, noise: { source: "given" },
  counts: { subspace_size: 40 }, seconds: { identify: 3 }, tables: ["identified.csv", "candidates.csv", "response.csv", "reference.csv"],
};
await mkdir(folder, { recursive: true });
for (const [name, lines] of Object.entries({ "identified.csv": identified, "reference.csv": reference, "response.csv": response, "candidates.csv": candidates })) {
  await writeFile(join(folder, name), lines.join("\n") + "\n");
}
await writeFile(join(folder, "summary.json"), JSON.stringify(summary, null, 1));
