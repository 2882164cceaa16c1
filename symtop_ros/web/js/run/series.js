// The series of a run as a table of comma-separated values.

import { NANO } from "../physics/course.js";
import { chooseWindow } from "../words/facts.js";

const SHARE = 200; // of a window: rows in it
const MOST = 20_000; // rows between two events; a longer time has them farther apart

/** @param {import("./run.js").Run} run @param {number} now ns */
export const writeSeries = ({ moments }, now) => {
  const names = ["phi", "theta", "psi"];
  const heads = [
    ...names.map((each) => `${each} (rad)`),
    ...names.map((each) => `${each}_dot (rad/s)`),
  ];
  const lines = [["time (s)", ...heads].join(",")];
  moments.forEach(({ time: begin, course }, k) => {
    const end = moments[k + 1]?.time ?? now;
    const wanted = Math.round((chooseWindow(course.free) / SHARE) * NANO);
    const step = Math.max(wanted, Math.ceil((end - begin) / MOST), 1);
    for (let time = begin; time < end; time += step) {
      const { angles, rates } = course.at(time - begin);
      const numbers = [angles.phi, angles.theta, angles.psi, rates.phi, rates.theta, rates.psi];
      lines.push([time / NANO, ...numbers].join(","));
    }
  });
  return `${lines.join("\n")}\n`;
};
