# Writes paired_tests.csv, paired_shares.csv and unit_means.csv. R 4.2.2, package coin; fixed seeds.
suppressMessages(library(coin))
number <- function(x) trimws(formatC(as.numeric(x), digits = 17, format = "g"))
rows <- list()
add <- function(case, d) {
  d0 <- d[d != 0]
  exact <- wilcoxsign_test(d ~ rep(0, length(d)), zero.method = "Wilcoxon", distribution = "exact")
  normal <- wilcox.test(d0, exact = FALSE, correct = TRUE)
  signs <- as.matrix(expand.grid(rep(list(c(-1, 1)), min(length(d), 12))))
  flip <- if (length(d) <= 12) mean(abs(signs %*% d) >= abs(sum(d)) - 1e-12) else NA
  t <- t.test(d)
  rows[[length(rows) + 1]] <<- data.frame(case = case, differences = paste(number(d), collapse = ";"),
    wilcoxon_exact = number(as.numeric(pvalue(exact))), wilcoxon_normal = number(normal$p.value),
    sign_flip = number(flip), t_low = number(t$conf.int[1]), t_high = number(t$conf.int[2]))
}
set.seed(1)
add("six", c(0.31, 0.12, 0.44, -0.05, 0.27, 0.18))
add("ties", c(1, 1, -1, 2, 0, 3, -2, 2, 1, 0, 4, 1))
add("normal_12", rnorm(12, 0.4))
add("normal_40", rnorm(40, 0.2))
add("rounded_150", round(rnorm(150, 0.1), 1))
add("rounded_300", round(rnorm(300, 0.05), 1))
write.csv(do.call(rbind, rows), "paired_tests.csv", row.names = FALSE, quote = FALSE)

# Pairs of yes and no: only_first and only_second of `pairs` differ.
mcnemar <- function(b, c, n) {
  z <- qnorm(0.975)
  p12 <- (b + 1) / (n + 2)  # Bonett and Price 2012
  p21 <- (c + 1) / (n + 2)
  half <- z * sqrt((p12 + p21 - (p12 - p21)^2) / (n + 2))
  data.frame(only_first = b, only_second = c, pairs = n, p = number(binom.test(b, b + c)$p.value),
    low = number(p12 - p21 - half), high = number(p12 - p21 + half))
}
write.csv(rbind(mcnemar(4, 25, 200), mcnemar(0, 6, 20), mcnemar(7, 7, 50), mcnemar(30, 12, 500), mcnemar(1, 0, 1)),
  "paired_shares.csv", row.names = FALSE, quote = FALSE)

# Means of units of two sets.
units <- function(case, x, y) {
  t <- t.test(x, y)
  data.frame(case = case, x = paste(number(x), collapse = ";"), y = paste(number(y), collapse = ";"),
    p = number(t$p.value), low = number(t$conf.int[1]), high = number(t$conf.int[2]))
}
write.csv(rbind(units("six_six", rnorm(6, 1), rnorm(6)), units("six_eight", rnorm(6), rnorm(8, 0.5, 3)),
  units("five_hundred", rnorm(5, 1, 0.1), rnorm(100)), units("two_two", c(1, 2), c(4, 7))), "unit_means.csv",
  row.names = FALSE, quote = FALSE)
