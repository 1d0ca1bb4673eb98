% SPDX-License-Identifier: LGPL-2.1-or-later
% Reads what crawler has written, in Octave (7 or later) or MATLAB (R2016b or later), without any package.
%
%   crawler run prm/paper/fig_s1.prm
%   crawler sweep prm/paper/fig_s1.prm --set "Sweep/Axes=Body/Elastic modulus : 1, 2, 4" --output output-sweep
%   octave contrib/octave/tutorial.m
%
% Other folders: set run_folder and sweep_folder before. draw = false leaves out the pictures.
if ~exist('run_folder', 'var'), run_folder = 'output-fig_s1'; end
if ~exist('sweep_folder', 'var'), sweep_folder = 'output-sweep'; end
if ~exist('draw', 'var'), draw = true; end
if draw && exist('OCTAVE_VERSION', 'builtin') && isempty(available_graphics_toolkits())
  disp('Octave has nothing to draw with here (no display, or no graphics toolkit): there will be no pictures');
  draw = false;
end

%% 1. The numbers of a run, with their bounds: summary.json
summary = jsondecode(fileread(fullfile(run_folder, 'summary.json')));
fprintf('%s: displacement %.10g +- %.1e\n', summary.status, summary.displacement, summary.displacement_error.total);
fprintf('speed of the last stride %.6g, work of the active stress %.6g\n', summary.gait.speed, summary.stress_power);

%% 2. A row for each time step and snapshot: statistics.csv
name = fullfile(run_folder, 'statistics.csv');
file = fopen(name);
columns = strsplit(fgetl(file), ',');
fclose(file);
statistics = dlmread(name, ',', 1, 0);
time = statistics(:, strcmp(columns, 'time [time]'));
displacement = statistics(:, strcmp(columns, 'displacement [length]'));
fprintf('%d rows, the last one at t = %g with displacement %.10g\n', numel(time), time(end), displacement(end));

%% 3. The fields over body and time: kymograph.vts has arrays in base 64, behind the number of their bytes
text = fileread(fullfile(run_folder, 'kymograph.vts'));
size_of_grid = regexp(text, 'WholeExtent="0 (\d+) 0 (\d+)', 'tokens', 'once');
n_points = str2double(size_of_grid{1}) + 1;
n_times = str2double(size_of_grid{2}) + 1;
arrays = regexp(text, '<DataArray[^>]*Name="(\w+)"[^>]*>([^<]*)<', 'tokens');
for i = 1:numel(arrays)
  bytes = matlab.net.base64decode(strtrim(arrays{i}{2}));
  values = typecast(uint8(bytes(9:end)), 'double');
  if numel(values) == n_points * n_times
    fields.(arrays{i}{1}) = reshape(values, n_points, n_times);  % [point, time]
  end
end
fprintf('fields:%s, %d points at %d times\n', sprintf(' %s', strjoin(fieldnames(fields)', ', ')), n_points, n_times);
fprintf('smallest stretch %.6g\n', min(fields.stretch(:)));

%% 4. The table of a sweep: results.h5
if exist('OCTAVE_VERSION', 'builtin')
  table_of_sweep = load(fullfile(sweep_folder, 'results.h5')).results;  % what is no letter or digit is "_" in names
  modulus = table_of_sweep.Body_Elastic_modulus;
  travelled = table_of_sweep.displacement;
  bound = table_of_sweep.displacement_error_total;
else
  read = @(column) h5read(fullfile(sweep_folder, 'results.h5'), ['/results/' column]);
  travelled = read('displacement');
  bound = read('displacement_error.total');
  table_of_sweep = readtable(fullfile(sweep_folder, 'results.csv'), 'VariableNamingRule', 'preserve');
  modulus = table_of_sweep.('Body/Elastic modulus');
end
fprintf('k = %g: displacement %.8g +- %.1e\n', [modulus(:), travelled(:), bound(:)]');

%% 5. Pictures
if draw
  figure
  imagesc([0 1], [0 1], fields.stretch')
  set(gca, 'ydir', 'normal')
  xlabel('s/L'), ylabel('t/T'), title('stretch'), colorbar
  figure
  plot(time, displacement)
  xlabel('time'), ylabel('displacement')
end
