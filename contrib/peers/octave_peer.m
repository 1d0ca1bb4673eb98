% SPDX-License-Identifier: LGPL-2.1-or-later
%
% Octave: the stretch by Chebyshev collocation, as in scipy_peer.py. METHOD is "lsode" (bdf of variable order in Fortran)
% or "ode15s" (SUNDIALS IDA); both have the analytic Jacobian. The lines that are read and written are those of body.h.
1;

function space = chebyshev(degree)
  % points, derivative matrix, quadrature weights on [0, 1]
  angle = pi * (degree:-1:0)' / degree;
  x = cos(angle);
  n = (0:degree)';
  scale = (1 + (mod(n, degree) == 0)) .* (-1) .^ n;
  D = (scale * (1 ./ scale')) ./ (x - x' + eye(degree + 1));
  D -= diag(diag(D));
  D -= diag(sum(D, 2));
  moments = zeros(degree + 1, 1);
  moments(1:2:end) = 1 ./ (1 - n(1:2:end) .^ 2);
  space = struct("s", (1 + x) / 2, "D", 2 * D, "weights", (cos(n * angle') \ moments)');
end

function body = prepare(a, chi, k, degree)
  persistent known = cell(1, 1000);
  if isempty(known{degree})
    known{degree} = chebyshev(degree);
  end
  space = known{degree};
  sine = sin(2 * pi * space.s);
  cosine = cos(2 * pi * space.s);
  m_s = chi * [2 * pi * k * cosine, sine - 2 * pi * k * cosine, cosine + 2 * pi * k * sine];
  body.a = a;
  body.chi = chi;
  body.force = [k * space.D, m_s];
  body.rows = [space.D(2:end-1, :); space.weights];
  body.inner = k * space.D(:, 2:end-1);
end

function [v, w, mobility] = velocity(t, y, body)
  sine = sin(2 * pi * t);
  last = 1 + body.chi * sine;
  w = [last; y(1:end-1); last];
  if body.a == -1
    mobility = w;
  else
    mobility = w .^ -body.a;
  end
  v = mobility .* (body.force * [w; 1; cos(2 * pi * t); sine]);
end

function rate = rate_of(t, y, body)
  rate = body.rows * velocity(t, y, body);
end

function J = jacobian_of(t, y, body)
  [v, w, mobility] = velocity(t, y, body);
  by_w = mobility .* body.inner;
  n = numel(w);
  diagonal = 2:n + 1:(n - 2) * n; % by_w(i+1, i)
  by_w(diagonal) -= body.a * (v(2:end-1) ./ w(2:end-1))';
  J = [body.rows * by_w, zeros(n - 1, 1)];
end

function value = run(method, a, chi, k, end_time, degree, tolerance)
  body = prepare(a, chi, k, degree);
  start = [ones(degree - 1, 1); 0];
  if strcmp(method, "lsode")
    lsode_options("absolute tolerance", tolerance);
    lsode_options("relative tolerance", 0);
    lsode_options("step limit", 100000);
    [y, state] = lsode({@(y, t) rate_of(t, y, body), @(y, t) jacobian_of(t, y, body)}, start, [0; end_time]);
    value = y(end, end);
    if state != 2
      value = NaN;
    end
  else
    options = odeset("AbsTol", tolerance, "RelTol", 1e-14, "Jacobian", @(t, y) jacobian_of(t, y, body));
    [t, y] = ode15s(@(t, y) rate_of(t, y, body), [0, end_time], start, options);
    value = y(end, end);
    if t(end) < end_time
      value = NaN;
    end
  end
end

warning("off", "all");
while ischar(line = fgetl(stdin))
  if isempty(line)
    continue;
  end
  words = strsplit(strtrim(line), " ");
  n = cellfun(@str2double, words(2:end));
  begin = cputime();
  try
    for i = 1:n(8)
      value = run(words{1}, n(1), n(2), n(3), n(4), n(5), n(7));
    end
  catch
    value = NaN;
  end
  if isfinite(value)
    printf("%.16g %.6g\n", value, (cputime() - begin) / n(8));
  else
    printf("failed\n");
  end
  fflush(stdout);
end
