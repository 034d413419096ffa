# SPDX-License-Identifier: GPL-3.0-or-later
# Means over seeds of the rows of plots/beds/soft.sh, and the limits of hard
# contacts.
#   awk -v what=groups|limits|budget -f softness.awk ROW...
# groups: set (basic, or phi with v_min, at 8 s or at rest), softness (1/kr), kr,
#   beds, union and its standard error, z, held, overlap, t, evaluations, cpu.
# limits: set, U, its 95 % half-width, c, beds, by least squares over beds with
#   kr >= 30.
# budget: source, setting, cpu, error, uncertainty (one standard error), limit: 1
#   where the error is less than that, which is then what is known.
BEGIN { FS = OFS = "\t" }
FNR == 1 { delete at; for (k = 1; k <= NF; k++) at[$k] = k; next }
function c(name) { return $(at[name]) }
{
  rests = c("until-rest") != "-"
  end = rests ? "at rest" : c("time") != "-" ? c("time") " s" : "8 s"
  friction = c("model") == "basic" ? 0 : c("friction") == "-" ? 0.2 : c("friction")
  vmin = friction == 0 ? "-" : c("vmin") == "-" ? 0.01 : c("vmin") + 0
  # beds of the paper's parameters belong to the budget alone
  bulk = FILENAME ~ /\/bulk\//
  own = c("tol") != "-" || c("base") != "-" || c("time") != "-" && !rests
  if (bulk) {
    end = "8 s, bulk"
    own = 0
  }
  seed = c("seed")
  if (own) {
    source = c("tol") != "-" ? "tol" : c("base") != "-" ? "base" : "time"
    setting = c(source)
    if (source == "base") sub(/,.*/, "", setting)
    add(source, setting + 0)
  } else
    add(friction SUBSEP vmin SUBSEP end, c("kr") + 0)
}
function add(set, x,  k) {
  k = set SUBSEP SUBSEP x
  if (!(set in sets)) { order[++count] = set; sets[set] = 1 }
  if (!(k in n)) xs[set, ++number[set]] = x
  i = ++n[k]
  u[k, i] = c("union"); seeds[k, i] = seed; value[k, seed] = c("union")
  s[k] += c("union"); q[k] += c("union")^2
  z[k] += c("z"); held[k] += c("held"); overlap[k] += c("overlap")
  t[k] += c("t"); e[k] += c("evaluations"); cpu[k] += c("cpu")
}
function key(set, x) { return set SUBSEP SUBSEP x }
function mean(k) { return s[k] / n[k] }
function error(k,  v) { # standard, of the mean
  if (n[k] < 2) return 0
  v = (q[k] - s[k]^2 / n[k]) / (n[k] - 1)
  return v > 0 ? sqrt(v / n[k]) : 0
}
# Student's t for 95 %, from its expansion in 1/degrees of freedom, good to 1 %
# from 3 degrees on
function student(f,  x) {
  x = 1.959964
  return x + (x^3 + x) / (4 * f) + (5 * x^5 + 16 * x^3 + 3 * x) / (96 * f^2)
}
# Least squares of y = U + c f(x) over beds; sets fit_u, fit_c, fit_error
function fit(set, least,  i, j, k, x, m, sx, sy, sxx, sxy, d, squares) {
  for (i = 1; i <= number[set]; i++) {
    if (xs[set, i] < least) continue
    k = key(set, xs[set, i]); x = 1 / xs[set, i]
    for (j = 1; j <= n[k]; j++) {
      m++; sx += x; sxx += x * x; sy += u[k, j]; sxy += x * u[k, j]
    }
  }
  d = m * sxx - sx * sx
  fit_beds = m
  if (m < 3 || d <= 0) return 0
  fit_c = (m * sxy - sx * sy) / d
  fit_u = (sy - fit_c * sx) / m
  for (i = 1; i <= number[set]; i++) {
    if (xs[set, i] < least) continue
    k = key(set, xs[set, i])
    for (j = 1; j <= n[k]; j++)
      squares += (u[k, j] - fit_u - fit_c / xs[set, i])^2
  }
  fit_error = sqrt(squares / (m - 2) * sxx / d)
  slope_error = sqrt(squares / (m - 2) * m / d)
  return 1
}
function name(set,  p) {
  split(set, p, SUBSEP)
  return p[1] == 0 ? "no friction, " p[3] : \
    "friction " p[1] ", v_min " p[2] " m/s, " p[3]
}
function budget(source, setting, time, err, sure,  limit) {
  err = err < 0 ? -err : err
  limit = err < sure
  print source, setting, time, limit ? sure : err, sure, limit
}
# Mean difference by seed of two settings; sets pair_mean, pair_error
function pairs(a, b,  j, d, m, sd, qd) {
  m = sd = qd = 0
  for (j = 1; j <= n[a]; j++) {
    if (!((b, seeds[a, j]) in value)) continue
    d = u[a, j] - value[b, seeds[a, j]]
    m++; sd += d; qd += d * d
  }
  pair_mean = m ? sd / m : 0
  pair_error = m > 1 ? sqrt((qd - sd * sd / m) / (m - 1) / m) : 0
}
function sorted(set,  i, j, x) { # by insertion
  for (i = 2; i <= number[set]; i++) {
    x = xs[set, i]
    for (j = i - 1; j >= 1 && xs[set, j] > x; j--) xs[set, j + 1] = xs[set, j]
    xs[set, j + 1] = x
  }
}
END {
  for (i = 1; i <= count; i++) sorted(order[i])
  if (what == "groups") {
    print "set", "softness", "kr", "beds", "union", "error", "z", "held", \
      "overlap", "t", "evaluations", "cpu"
    for (i = 1; i <= count; i++) {
      set = order[i]
      if (index(set, SUBSEP) == 0) continue
      for (j = 1; j <= number[set]; j++) {
        k = key(set, xs[set, j])
        print name(set), 1 / xs[set, j], xs[set, j], n[k], \
          sprintf("%.4f", mean(k)), sprintf("%.4f", error(k)), \
          sprintf("%.2f", z[k] / n[k]), sprintf("%.2f", held[k] / n[k]), \
          sprintf("%.4f", overlap[k] / n[k]), sprintf("%.3g", t[k] / n[k]), \
          sprintf("%.3g", e[k] / n[k]), sprintf("%.2f", cpu[k] / n[k])
      }
    }
  } else if (what == "limits") {
    print "set", "hard", "interval", "slope", "beds"
    for (i = 1; i <= count; i++) {
      set = order[i]
      if (index(set, SUBSEP) && fit(set, 29))
        print name(set), sprintf("%.4f", fit_u), \
          sprintf("%.4f", student(fit_beds - 2) * fit_error), \
          sprintf("%.2f", fit_c), fit_beds
    }
  } else {
    print "source", "setting", "cpu", "error", "uncertainty", "limit"
    # softness: by the law, and where it does not hold from its limit
    set = 0.2 SUBSEP 0.01 SUBSEP "8 s"
    if (fit(set, 29))
      for (j = 1; j <= number[set]; j++) {
        k = key(set, xs[set, j])
        budget("softness", xs[set, j], cpu[k] / n[k],
          xs[set, j] < 29 ? mean(k) - fit_u : fit_c / xs[set, j],
          xs[set, j] < 29 ? sqrt(error(k)^2 + fit_error^2) : slope_error / xs[set, j])
      }
    # creep, at kr 60: from the least v_min, by seed; largest first
    for (i = 1; i <= count; i++) {
      split(order[i], p, SUBSEP)
      if (p[1] == 0.2 && p[3] == "8 s" && (key(order[i], 60) in n)) {
        at_vmin[p[2]] = key(order[i], 60)
        xs["vmin", ++number["vmin"]] = p[2] + 0
      }
    }
    sorted("vmin")
    for (j = number["vmin"]; j > 1; j--) {
      k = at_vmin[xs["vmin", j]]
      pairs(k, at_vmin[xs["vmin", 1]])
      budget("creep", xs["vmin", j], cpu[k] / n[k], pair_mean, pair_error)
    }
    # walls: from the limit of U + c/side
    if (fit("base", 0))
      for (j = 1; j <= number["base"]; j++) {
        k = key("base", xs["base", j])
        budget("walls", xs["base", j], cpu[k] / n[k], mean(k) - fit_u,
          sqrt(error(k)^2 + fit_error^2))
      }
    # tolerance: from the least; time: from the longest, by seed
    for (j = 2; j <= number["tol"]; j++) {
      k = key("tol", xs["tol", j])
      pairs(k, key("tol", xs["tol", 1]))
      budget("integration", xs["tol", j], cpu[k] / n[k], pair_mean, pair_error)
    }
    for (j = 1; j < number["time"]; j++) {
      k = key("time", xs["time", j])
      pairs(k, key("time", xs["time", number["time"]]))
      budget("not at rest", xs["time", j], cpu[k] / n[k], pair_mean, pair_error)
    }
    # chance: of the mean of 1, 4, 16 and 64 beds by the default tolerance
    k = key("tol", 0.002)
    for (j = 1; j <= 64; j *= 4)
      if (k in n)
        budget("chance", j, j * cpu[k] / n[k], error(k) * sqrt(n[k] / j), 0)
  }
}
