# Plots and the animation, from what the program wrote to the folder that gnuplot is started in.
set datafile separator ','
set term pngcairo size 900,380 font ',11' background 'white'
set key noenhanced
set grid lc rgb '#dddddd'

set output 'comparison.png'
set multiplot layout 1,2
set logscale xy
set format '10^{%T}'
set ylabel 'error of the saturation (L^1)'
set xlabel 'triangles, mean over time'
plot 'comparison.csv' using ($1 == 0 ? $2 : NaN):3 with linespoints pt 5 title 'uniform', \
     '' using ($1 == 1 ? $2 : NaN):3 with linespoints pt 7 title 'adapted'
set xlabel 'processor seconds'
plot 'comparison.csv' using ($1 == 0 ? $5 : NaN):3 with linespoints pt 5 title 'uniform', \
     '' using ($1 == 1 ? $5 : NaN):3 with linespoints pt 7 title 'adapted'
unset multiplot

set output 'history.png'
set multiplot layout 1,2
unset logscale
set format
set key left top
set yrange [0:2]
set xlabel 'time'
set ylabel 'x'
set y2label 'fingers half-way'
set y2tics 1
set y2range [0:8]
plot 'history.csv' using 1:4 with lines title 'tip', '' using 1:3 with lines title 'root', \
     '' using 1:5 axes x1y2 with steps title 'fingers half-way'
unset y2label
unset y2tics
set yrange [0:*]
set ylabel 'triangles'
plot 'history.csv' using 1:2 with lines notitle
unset multiplot

frames = system("ls animation/*.png")
unset key; unset tics; unset border; unset xlabel; unset ylabel; unset grid
set lmargin 0; set rmargin 0; set tmargin 0; set bmargin 0
set autoscale
set size ratio -1

set term gif animate delay 12 loop 0 size 496,276
set output 'fingers.gif'
do for [frame in frames] {
  plot frame binary filetype=png with rgbimage
}
