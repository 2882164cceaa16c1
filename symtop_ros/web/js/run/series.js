// The series of a run as a table of comma-separated values.

import { NANO } from "../physics/course.js";
import { chooseWindow } from "../words/facts.js";

const SHARE = 200; // of a window: rows in it
const MOST = 20_000; // rows between two events; a longer time has them farther apart

/** @param {import("./run.js").Run} run @param {number} now ns */
export const writeSeries = ({ moments }, now) => {
  const lines = ["time (s),theta (rad),phi_dot (rad/s),psi_dot (rad/s)"];
  moments.forEach(({ time: begin, course }, k) => {
    const end = moments[k + 1]?.time ?? now;
    const wanted = Math.round((chooseWindow(course.free) / SHARE) * NANO);
    const step = Math.max(wanted, Math.ceil((end - begin) / MOST), 1);
    for (let time = begin; time < end; time += step) {
      const { angles, rates } = course.at(time - begin);
      lines.push([time / NANO, angles.theta, rates.phi, rates.psi].join(","));
    }
  });
  return `${lines.join("\n")}\n`;
};
